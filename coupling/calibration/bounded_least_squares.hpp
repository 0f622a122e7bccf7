#pragma once
// Weighted linear least squares whose unknowns have least values.
#include <cstddef>
#include <span>
#include <vector>

namespace drumlin::coupling {

/// Normal equations of sum over rows of weight (target - row . c)^2; n unknowns.
struct NormalEquations {
  explicit NormalEquations(std::size_t unknowns) : matrix(unknowns * unknowns, 0.0), right(unknowns, 0.0) {}
  /// `row` has n entries.
  void add(double weight, std::span<const double> row, double target);

  std::vector<double> matrix;  ///< n x n, symmetric
  std::vector<double> right;
};

/// The minimum with c_j >= least_j (minus infinity: free), by an active set and the signs of its multipliers.
/// Needs a positive diagonal.
std::vector<double> bounded_minimum(const NormalEquations& equations, const std::vector<double>& least);

}  // namespace drumlin::coupling
