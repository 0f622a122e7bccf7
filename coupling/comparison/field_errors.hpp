#pragma once
// Errors of one side against the other, field by field and zone by zone.
#include <string>
#include <vector>

#include "coupling/comparison/compared_fields.hpp"
#include "coupling/core/results/profile_set.hpp"

namespace drumlin::coupling {

/// A stretch of depth, from <= z <= to, in d below the free surface (z < 0).
struct Zone {
  std::string name;
  double from = 0;
  double to = 0;
};

/// flowing: -H .. -surface_margin; static: wall + wall_margin .. -H; all: both. H, the surface and the wall
/// are the particles': both sides are compared at the same places. The margins leave out the layers in which
/// the packing ends, where no continuum with one volume fraction can follow it.
struct ZoneOptions {
  double surface_margin = 3;  ///< d
  double wall_margin = 3;     ///< d above the lowest layer of the particles
};
/// `H` may be NaN (no flowing layer was found): flowing and static are empty then.
std::vector<Zone> zones_of(const ProfileSet& particles, double H, const ZoneOptions& options = {});

/// One field of both sides at the places of the particles' layers or nodes. NaN where a side has no value.
/// (Of two runs of one kind "particles" is the first, "continuum" the second.)
struct FieldOverlay {
  std::string field;
  std::vector<double> x, z;
  std::vector<double> particles;
  std::vector<double> ci99;  ///< of the particles, NaN where unknown
  std::vector<double> continuum;
  std::vector<double> continuum_ci99;  ///< of the continuum: what its calibration leaves open; NaN: unknown
  std::vector<char> noise;             ///< 1 where a side was measured, but its interval leaves the sign open
  bool present = true;                 ///< false: a side does not have this field at all
};

/// The continuum is interpolated linearly to the particles' layers and never extrapolated. Throws InputError
/// if a side lacks v_x, a stress or the shear rate where the field needs it.
FieldOverlay overlay(const std::string& field, const ProfileSet& particles, const ProfileSet& continuum);

/// Errors of a field over a zone; NaN where no place of the zone has values on both sides. With p, c the
/// values of the particles and of the continuum at the places of the zone, s_p, s_c their half widths:
struct FieldErrors {
  double rel_l2 =
      0;  ///< sqrt(sum (c - p)^2 / sum p^2): relative to the zone's own norm, never to the global maximum
  double rms = 0;               ///< sqrt(mean (c - p)^2), in the unit of the field (decades, degrees)
  double max = 0;               ///< max |c - p|, in the unit of the field
  double inside_band = 0;       ///< share of the places with |c - p| <= s_p; NaN when none has an interval
  int layers = 0;               ///< places compared
  int undefined = 0;            ///< places where the particles have a value and the continuum has none
  double max_x = 0, max_z = 0;  ///< where the largest difference is
  double inside_both = 0;       ///< share of the places with |c - p| <= sqrt(s_p^2 + s_c^2)
  double interval_rms = 0;      ///< rms of s_p: what the particles themselves leave open
  double particles_rms = 0;     ///< rms of p: rms and interval_rms over it are relative
  /// 1 - sum max(0, |c - p| - s)^2 / sum (c - p)^2: the part of the squared error that lies within the band.
  /// s is s_c (calibration), s_p (particles), sqrt(s_p^2 + s_c^2) (both); NaN without a band or an error.
  double explained_by_calibration = 0, explained_by_particles = 0, explained_by_both = 0;
  int noise = 0;  ///< places left out because a side's interval leaves the sign open
};
FieldErrors errors_in(const FieldOverlay& overlay, const Zone& zone);
FieldErrors errors_at(const FieldOverlay& overlay, const std::vector<std::size_t>& places);

}  // namespace drumlin::coupling
