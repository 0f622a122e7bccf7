#pragma once
// How far single contacts are from their laws, one by one and on vectors.
#include <span>

#include "particles/contact_law/laws.hpp"

namespace drumlin::particles {

/// e_a^2 (residual.hpp) of a contact with lambda_max(W_aa), its coefficients, impulses and velocities.
template <class Law>
double squared_error(double lambda, const double* mu, const double* r, const double* u) {
  using namespace contact_law;
  return squared_natural_residual(Law{}, 1 / lambda, numbers_at<Law::coefficients>(mu),
                                  numbers_at<Law::unknowns>(r), numbers_at<Law::unknowns>(u)) *
         (lambda * lambda);
}

/// The same of contacts of discs with a plain law that stand one after the other, the very same numbers, on
/// vectors. Each has 1 / W_nn, its coefficients, impulses and velocities; lambda_max(W_aa) is
/// `largest_in_W_nn` times W_nn.
template <class Law>
void set_squared_errors(double largest_in_W_nn, const double* inverse_W_nn, const double* mu, const double* r,
                        const double* u, std::span<double> errors);

}  // namespace drumlin::particles
