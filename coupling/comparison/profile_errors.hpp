#pragma once
// How far one profile lies from another, field by field and zone by zone.
#include <string>
#include <vector>

#include "coupling/exchange/profile_set.hpp"

namespace drumlin {

/// A stretch of depth, from <= z <= to, in d below the free surface (z < 0).
struct Zone {
  std::string name;
  double from = 0;
  double to = 0;
};

/// flowing: -H .. -surface_margin; static: wall + wall_margin .. -H; all: both. H, the surface and the wall
/// are the particles': both sides are judged at the same places. The margins leave out the layers in which
/// the packing ends, where no continuum with one volume fraction can follow it.
struct ZoneOptions {
  double surface_margin = 3;  ///< d
  double wall_margin = 3;     ///< d above the lowest layer of the particles
};
/// `H` may be NaN (no flowing layer was found): flowing and static are empty then.
std::vector<Zone> zones_of(const ProfileSet& particles, double H, const ZoneOptions& options = {});

/// One field of both sides at the particles' layers. NaN where a side has no value.
struct FieldOverlay {
  std::string field;
  std::vector<double> z;
  std::vector<double> particles;
  std::vector<double> ci99;  ///< of the particles, NaN where unknown
  std::vector<double> continuum;
};

/// The fields that are compared: v_x, sigma_zz, sigma_xz, sigma_xx, log10_shear_rate.
const std::vector<std::string>& compared_fields();

/// The continuum is interpolated linearly to the particles' layers and never extrapolated. Of
/// log10_shear_rate the particles have a value where their shear rate exceeds its own 99 % interval: deeper
/// down its sign is not known. Its ci99 is that of the shear rate divided by the shear rate and ln 10. Throws
/// InputError if a side lacks the column.
FieldOverlay overlay(const std::string& field, const ProfileSet& particles, const ProfileSet& continuum);

/// Errors of a field over a zone; NaN where no layer of the zone has values on both sides.
/// With p, c the values of the particles and of the continuum in the layers of the zone:
struct FieldErrors {
  double rel_l2 =
      0;  ///< sqrt(sum (c - p)^2 / sum p^2): relative to the zone's own norm, never to the global maximum
  double rms = 0;          ///< sqrt(mean (c - p)^2), in the unit of the field (decades for log10_shear_rate)
  double max = 0;          ///< max |c - p|, in the unit of the field
  double inside_band = 0;  ///< share of the layers with |c - p| <= ci99; NaN when no layer has an interval
  int layers = 0;          ///< compared
  int undefined = 0;       ///< layers in which the particles have a value and the continuum has none
};
FieldErrors errors_in(const FieldOverlay& overlay, const Zone& zone);

}  // namespace drumlin
