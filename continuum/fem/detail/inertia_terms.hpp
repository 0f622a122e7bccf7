#pragma once
// nu (du/dt + u.grad u) at a quadrature point, and its derivative. Private to fem/.
#include "continuum/fem/detail/cell_shapes.hpp"

namespace drumlin::continuum::fem {

/// u.grad u.
inline Vec2 convective_acceleration(const PointMotion& at) {
  return {at.u[0] * at.gradient[0][0] + at.u[1] * at.gradient[0][1],
          at.u[0] * at.gradient[1][0] + at.u[1] * at.gradient[1][1]};
}

/// Derivative of density u.grad u + per_time u.
inline void add_inertia_tangent(const CellShapes& s, unsigned int q, const PointMotion& at, double density,
                                double per_time, double JxW, VelocityTangent& tangent) {
  const CellShapes::Point& shape = s.points[q];
  for (unsigned int b = 0; b < s.nodes; ++b) {
    const double moved = density * shape.value[b] * JxW;
    const double along =
        (density * (at.u[0] * shape.x[b] + at.u[1] * shape.z[b]) + per_time * shape.value[b]) * JxW;
    for (unsigned int c = 0; c < 2; ++c) {
      const double to_x = moved * at.gradient[0][c] + (c == 0 ? along : 0);
      const double to_z = moved * at.gradient[1][c] + (c == 1 ? along : 0);
      auto& [x, z] = tangent[c][b];
      for (unsigned int a = 0; a < s.nodes; ++a) {
        x[a] += to_x * shape.value[a];
        z[a] += to_z * shape.value[a];
      }
    }
  }
}

}  // namespace drumlin::continuum::fem
