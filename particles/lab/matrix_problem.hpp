#pragma once
// A contact problem from the entries of its matrix, checked.
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "particles/lab/block_delassus.hpp"

namespace drumlin::particles {

inline constexpr double largest_friction = 100;  ///< as in a scene

struct MatrixEntry {
  std::int32_t row = 0, column = 0;
  double value = 0;
};

/// What is done with a fault: it throws. `name`: of the input that is at fault, "W", "W/x", "q" or "mu".
using Refusal = std::function<void(const std::string& name, const std::string& what)>;

struct MatrixProblem {
  BlockProblem problem;  ///< with W made symmetric
  /// Largest |W_ij - W_ji| over the mean trace of the two diagonal blocks, before that.
  double asymmetry = 0;
};

/// u = W r + q with two rows per contact, normal first; entries may repeat and are then added. Refused are
/// numbers of other lengths (2 per contact in q, 1 in mu), an index outside of the matrix, numbers that are
/// not finite, friction below 0 or above 100, a contact without a positive definite diagonal block, and a W
/// that is asymmetric by more than 1e-5.
MatrixProblem matrix_problem(std::span<const MatrixEntry> W, std::vector<double> q, std::vector<double> mu,
                             const Refusal& refuse);

/// The same of rows and columns that stand one below the other (row-major), 2 contacts each. Throws
/// std::invalid_argument.
BlockProblem dense_problem(std::span<const double> W, std::vector<double> q, std::vector<double> mu);

}  // namespace drumlin::particles
