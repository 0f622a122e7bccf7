#pragma once
// Comparison of two flows in layers: plane shear between plates, a layer on a slope, an upright chute. The
// same slope and height on both sides, layer against layer (docs/formats/comparison.md).
#include <string>
#include <vector>

#include "coupling/comparison/comparison.hpp"

namespace drumlin::coupling {

/// A drum where there is one, else what the header says, if anything.
std::optional<Geometry> geometry_of(const ProfileSet& profiles);

/// Throws InputError that names both geometries unless they are one and the same, and a known one.
void require_same_geometry(const ProfileSet& first, const ProfileSet& second);

/// Where a flow in layers begins and ends, d. Of a continuum its walls, or wall and surface. Of particles the
/// places between which a packing with the volume fraction of the bulk would hold the same grains (Gibbs'
/// dividing planes): glued discs and a loose surface then count for what they hold.
struct LayerExtent {
  double base = 0;  ///< z of the lower wall
  double top = 0;   ///< z of the upper wall, of the surface, or of the middle of a chute
  double height() const { return top - base; }
};

/// Zones of a flow in layers, z of the first side. bulk: at least `wall_margin` above the lowest layer and
/// `top_margin` below the highest that is half as dense as the densest (in a chute up to the middle): the
/// layers of bulk_mu, bulk_I, ... of measured.json. near_base and near_top: the layers outside of it that lie
/// wholly between base and top. all: every layer between them.
struct LayerOptions {
  double wall_margin = 4, top_margin = 4;  ///< d
};
std::vector<Zone> layer_zones(const ProfileSet& first, const LayerOptions& options = {});

/// The base and the top of one side. Throws InputError without the column nu or wall_z, or where no layer of
/// the bulk is left.
LayerExtent layer_extent(const ProfileSet& profiles, const LayerOptions& options = {});

/// v_x, shear_rate, sigma_zz, sigma_xz, sigma_xx, p, mu, I, k, nu.
const std::vector<std::string>& compared_layer_fields();

struct LayerComparison {
  Geometry geometry = Geometry::plane_shear;
  Registration registration = Registration::axis;  ///< axis: each from its own base, for layers have no axis
  double offset = 0;                               ///< added to the second side's z
  LayerExtent first, second;                       ///< each in its own z
  std::vector<FieldComparison> fields;
  /// theta_deg, height, Q, surface_speed (1 d below the top), and of the bulk shear_rate, sigma_zz, sigma_xz,
  /// mu, I, nu: of both sides means over the same layers.
  std::vector<ScalarPair> scalars;
};

/// Throws InputError, all reasons at once, unless both sides name the same geometry in layers, diameter_m and
/// theta_deg agree to 1e-3 (angles to 0.01 deg), heights to a tenth, and both are reduced or neither.
LayerComparison compare_layers(const ComparedSide& first, const ComparedSide& second, Registration by,
                               const LayerOptions& options = {});

/// NAME_particles with its interval and NAME_continuum, for overlay.csv.
ProfileSet layer_overlay(const LayerComparison& comparison, const ProfileSet& first);

}  // namespace drumlin::coupling
