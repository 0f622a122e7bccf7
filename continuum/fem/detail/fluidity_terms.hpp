#pragma once
// A^2 lap g/g = mu_loc - mu at a quadrature point, with y = ln g, and what y does to the stress. Private to
// fem/.
#include <deal.II/lac/full_matrix.h>

#include "continuum/fem/detail/cell_shapes.hpp"
#include "continuum/rheology/threshold_fluidity.hpp"

namespace drumlin::continuum::fem {

inline double dot(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return a[0] * b[0] + a[1] * b[1];
}

/// A^2 (grad y, grad w) - A^2 (|grad y|^2, w) + (mu_loc - mu, w): lap g/g = lap y + |grad y|^2, and no flux
/// through the sides.
inline void add_fluidity_residual(const CellShapes& s, unsigned int q, const PointValues& at,
                                  double amplitude, const FluidityBalance& balance, double JxW,
                                  dealii::Vector<double>& residual) {
  const double A2 = amplitude * amplitude, steep = dot(at.fluidity_slope, at.fluidity_slope);
  const CellShapes::Point& shape = s.points[q];
  for (unsigned int a = 0; a < s.corners; ++a)
    residual[s.fluidity[a]] += (A2 * (dot(at.fluidity_slope, shape.slope[a]) - steep * shape.linear[a]) +
                                (balance.mu_loc - balance.mu) * shape.linear[a]) *
                               JxW;
}

/// Its derivative, and that of the stress by y.
template <class Base>
void add_fluidity_tangent(const CellShapes& s, unsigned int q, const PointValues& at, double amplitude,
                          const FluidityResponse<Base>& response, double JxW,
                          dealii::FullMatrix<double>& matrix) {
  const double A2 = amplitude * amplitude;
  const FluidityBalance& balance = response.balance;
  const CellShapes::Point& shape = s.points[q];
  for (unsigned int a = 0; a < s.corners; ++a) {
    const unsigned int i = s.fluidity[a];
    const double w = shape.linear[a] * JxW;
    for (unsigned int c = 0; c < 2; ++c)
      for (unsigned int b = 0; b < s.nodes; ++b) {
        const unsigned int j = s.velocity[c][b];
        matrix(i, j) += 0.5 * balance.by_rate * contraction(response.right, shape.rate(c, b)) * w;
        matrix(j, i) += contraction(response.by_fluidity, shape.rate(c, b)) * w;
      }
    for (unsigned int b = 0; b < s.corners; ++b) {
      matrix(i, s.pressure[b]) += balance.by_pressure * shape.linear[b] * w;
      matrix(i, s.fluidity[b]) +=
          A2 * dot(shape.slope[a], shape.slope[b]) * JxW +
          (balance.mu * shape.linear[b] - 2 * A2 * dot(at.fluidity_slope, shape.slope[b])) * w;
    }
  }
}

}  // namespace drumlin::continuum::fem
