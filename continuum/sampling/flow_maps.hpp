#pragma once
// A solved flow over a square grid of points: maps.csv.
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "continuum/fem/flow_field.hpp"

namespace drumlin {

/// What a map shows.
struct MapArea {
  double x_min = 0, x_max = 0, z_min = 0, z_max = 0;
  std::function<bool(Vec2)> inside;  ///< whether a point of the rectangle belongs to the domain
  std::function<Vec2(Vec2 point, Vec2 velocity)> seen;  ///< from the laboratory frame; empty: that frame
  std::vector<std::pair<std::string, double>> header;   ///< lines of the file besides reduced and spacing
};

/// Points of a square grid, multiples of `spacing`, with velocity, pressure, stresses, I, mu, viscosity and
/// well-posedness margin; in the axes of the domain. Written by the first rank. Throws
/// IoError.
void write_maps(const std::filesystem::path& file, const FlowField& field, const MapArea& area,
                double spacing, bool reduced);

}  // namespace drumlin
