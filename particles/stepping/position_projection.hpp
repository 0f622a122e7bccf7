#pragma once
// Removes overlap by moving discs along the normals of their contacts, velocities untouched.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"

namespace drumlin {

/// A contact at the end of a step: the normal points from j to i; j < 0 is a wall.
struct ClosePair {
  std::int32_t i = 0, j = 0;
  double gap = 0, n_x = 0, n_z = 0;
};

/// Gauss-Seidel sweeps on 0 <= gap + n.(d_i - d_j), lambda >= 0 in the metric of the masses (the least displacement), in
/// the order of `pairs`. `scratch` is overwritten.
void project_positions(Bodies& bodies, std::span<const ClosePair> pairs, int sweeps, std::vector<double>& scratch);

}  // namespace drumlin
