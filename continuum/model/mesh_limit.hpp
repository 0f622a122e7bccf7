#pragma once
// Richardson extrapolation of a number over meshes whose cells halve.
#include <optional>
#include <span>

namespace drumlin::continuum {

struct MeshLimit {
  double order = 0;  ///< of the error in the size of the cells
  double value = 0;  ///< on cells of no size
};

/// Richardson's extrapolation of values on meshes whose cells halve from one to the next, from the last three
/// of them. Empty where the order does not allow: fewer than three, last two changes of different sign or of
/// rounding's size (1e-9 of the value), an order outside 0.9 .. 4.5 (Q2-Q1 has 2 to 4 in functionals), or,
/// with four or more, an order that differs by more than a half from that of the three before.
[[nodiscard]] std::optional<MeshLimit> mesh_limit(std::span<const double> values);

}  // namespace drumlin::continuum
