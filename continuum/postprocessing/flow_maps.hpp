#pragma once
// A solved flow over a square grid of points, under the names of the particles' maps (docs/formats/maps.md).
#include <functional>
#include <optional>
#include <vector>

#include "continuum/fem/flow_field.hpp"
#include "coupling/core/results/field_map.hpp"

namespace drumlin::continuum {

/// What a map shows.
struct MapArea {
  double x_min = 0, x_max = 0, z_min = 0, z_max = 0;
  double z_zero = 0;                   ///< height of the map's z = 0 in the axes of the domain
  std::function<bool(Vec2)> inside;    ///< whether a point of the rectangle belongs to the domain
  double nu = 0;                       ///< volume fraction
  std::optional<RotatingFrame> frame;  ///< that velocities are seen from; absent: the laboratory
  RunHeader header;                    ///< the geometry alone
};

/// Nodes are multiples of `spacing`, NaN outside of the domain; axes of the domain from z_zero on. Scales and
/// the other lines of the header are the caller's. Collective, complete on every rank.
FieldMap flow_map(const FlowField& field, const MapArea& area, double spacing);

}  // namespace drumlin::continuum
