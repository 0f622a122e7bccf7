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
  for (unsigned int i = 0; i < s.n; ++i) {
    if (s.component[i] != fluidity_component) continue;
    const auto k = q * s.n + i;
    residual[i] += (A2 * (dot(at.fluidity_slope, s.slope[k]) - steep * s.value[k]) +
                    (balance.local - balance.mu) * s.value[k]) *
                   JxW;
  }
}

/// Its derivative, and that of the stress by y.
template <class Base>
void add_fluidity_tangent(const CellShapes& s, unsigned int q, const PointValues& at, double amplitude,
                          const FluidityResponse<Base>& response, double JxW,
                          dealii::FullMatrix<double>& matrix) {
  const double A2 = amplitude * amplitude;
  const FluidityBalance& balance = response.balance;
  for (unsigned int i = 0; i < s.n; ++i) {
    if (s.component[i] != fluidity_component) continue;
    const auto ki = q * s.n + i;
    const double w = s.value[ki] * JxW;
    for (unsigned int j = 0; j < s.n; ++j) {
      const auto kj = q * s.n + j;
      if (moves(s.component[j])) {
        matrix(i, j) += 0.5 * balance.by_rate * contraction(response.right, s.rate[kj]) * w;
        matrix(j, i) += contraction(response.by_fluidity, s.rate[kj]) * w;
      } else if (s.component[j] == pressure_component) {
        matrix(i, j) += balance.by_pressure * s.value[kj] * w;
      } else {
        matrix(i, j) += A2 * dot(s.slope[ki], s.slope[kj]) * JxW +
                        (balance.mu * s.value[kj] - 2 * A2 * dot(at.fluidity_slope, s.slope[kj])) * w;
      }
    }
  }
}

}  // namespace drumlin::continuum::fem
