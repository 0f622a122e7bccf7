#pragma once
// nu (du/dt + u.grad u) at a quadrature point, and its derivative. Private to fem/.
#include <deal.II/lac/full_matrix.h>

#include <array>

#include "continuum/fem/detail/cell_shapes.hpp"

namespace drumlin::continuum::fem {

/// Velocity and its gradient at a point.
struct PointMotion {
  std::array<double, 2> u{};
  std::array<std::array<double, 2>, 2> gradient{};  ///< [component][direction]
};

/// Gradient of a velocity shape function, from its strain rate.
inline std::array<double, 2> shape_gradient(const CellShapes& s, unsigned int i, std::size_t k) {
  const PlaneTensor& e = s.rate[k];
  return s.component[i] == 0 ? std::array{e.xx, 2 * e.xz} : std::array{2 * e.xz, e.zz};
}

inline PointMotion point_motion(const CellShapes& s, unsigned int q, const dealii::Vector<double>& local) {
  PointMotion at;
  for (unsigned int i = 0; i < s.n; ++i) {
    const unsigned int c = s.component[i];
    if (!moves(c)) continue;
    const auto k = q * s.n + i;
    const auto g = shape_gradient(s, i, k);
    at.u[c] += local[i] * s.value[k];
    at.gradient[c][0] += local[i] * g[0];
    at.gradient[c][1] += local[i] * g[1];
  }
  return at;
}

/// u.grad u.
inline Vec2 convective_acceleration(const PointMotion& at) {
  return {at.u[0] * at.gradient[0][0] + at.u[1] * at.gradient[0][1],
          at.u[0] * at.gradient[1][0] + at.u[1] * at.gradient[1][1]};
}

/// Derivative of density u.grad u + per_time u.
inline void add_inertia_tangent(const CellShapes& s, unsigned int q, const PointMotion& at, double density,
                                double per_time, double JxW, dealii::FullMatrix<double>& matrix) {
  for (unsigned int j = 0; j < s.n; ++j) {
    const unsigned int cj = s.component[j];
    if (!moves(cj)) continue;
    const auto kj = q * s.n + j;
    const auto g = shape_gradient(s, j, kj);
    const double along = density * (at.u[0] * g[0] + at.u[1] * g[1]) + per_time * s.value[kj];
    for (unsigned int i = 0; i < s.n; ++i) {
      const unsigned int ci = s.component[i];
      if (!moves(ci)) continue;
      const double turn = density * at.gradient[ci][cj] * s.value[kj];
      matrix(i, j) += (turn + (ci == cj ? along : 0)) * s.value[q * s.n + i] * JxW;
    }
  }
}

}  // namespace drumlin::continuum::fem
