#pragma once
// How far single contacts are from their laws, one by one and on vectors.
#include <algorithm>
#include <cmath>
#include <span>

#include "particles/contact/cone.hpp"

namespace drumlin::particles {

/// e_a^2 (residual.hpp) of a contact with lambda_max(W_aa), its dim - 1 coefficients of friction, impulses
/// and velocities.
template <int dim>
double squared_error(double lambda, const double* mu, const double* r, const double* u) {
  const double rho = 1 / lambda;
  double squares = 0;  // of e / lambda
  if constexpr (dim == 1) {
    const double n = r[0] - std::max(r[0] - rho * u[0], 0.0);  // NaN stays
    squares = n * n;
  } else if (std::max(mu[0], mu[dim - 2]) > steep_friction) {
    const double n = std::max(r[0] - rho * u[0], 0.0);
    squares = (n - r[0]) * (n - r[0]);
    for (int e = 1; e < dim; ++e) {
      const double t = std::clamp(r[e] - rho * u[e], -mu[e - 1] * n, mu[e - 1] * n) - r[e];
      squares += t * t;
    }
  } else if constexpr (dim == 3) {
    double n = r[0] - rho * (u[0] + mu[0] * std::abs(u[1]) + mu[1] * std::abs(u[2]));
    double t = r[1] - rho * u[1], roll = r[2] - rho * u[2];
    project_on_cone(mu[0], mu[1], n, t, roll);
    n -= r[0], t -= r[1], roll -= r[2];
    squares = n * n + t * t + roll * roll;
  } else {
    double n = r[0] - rho * (u[0] + mu[0] * std::abs(u[1])), t = r[1] - rho * u[1];
    project_on_cone(mu[0], n, t);
    n -= r[0], t -= r[1];
    squares = n * n + t * t;
  }
  return squares * (lambda * lambda);
}

/// The same of contacts of discs that stand one after the other, the very same numbers, on vectors. Each has
/// 1 / W_nn, dim - 1 coefficients of friction, dim impulses and dim velocities; lambda_max(W_aa) is
/// `largest_in_W_nn` times W_nn.
template <int dim>
void set_squared_errors(double largest_in_W_nn, const double* inverse_W_nn, const double* mu, const double* r,
                        const double* u, std::span<double> errors);

}  // namespace drumlin::particles
