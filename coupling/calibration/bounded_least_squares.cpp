#include "coupling/calibration/bounded_least_squares.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace drumlin::coupling {
namespace {

using Held = std::vector<bool>;

struct Problem {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right, least;
  Eigen::Index size() const { return right.size(); }
};

bool is_held(const Held& held, Eigen::Index j) { return held[static_cast<std::size_t>(j)]; }

Eigen::VectorXd minimum_with(const Problem& problem, const Held& held) {
  Eigen::MatrixXd matrix = problem.matrix;
  Eigen::VectorXd right = problem.right;
  for (Eigen::Index j = 0; j < problem.size(); ++j) {
    if (!is_held(held, j)) continue;
    right -= matrix.col(j) * problem.least(j);
    matrix.row(j).setZero();
    matrix.col(j).setZero();
    matrix(j, j) = 1;
    right(j) = problem.least(j);
  }
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  return scale.asDiagonal() * scaled.colPivHouseholderQr().solve((scale.asDiagonal() * right).eval()).eval();
}

// Holds what fell below; where nothing did, lets go of the one that wants to rise most.
bool changed(const Problem& problem, Held& held, const Eigen::VectorXd& at) {
  bool any = false;
  for (Eigen::Index j = 0; j < problem.size(); ++j)
    if (!is_held(held, j) && at(j) < problem.least(j)) any = held[static_cast<std::size_t>(j)] = true;
  if (any) return true;
  const Eigen::VectorXd rise = problem.right - problem.matrix * at;
  Eigen::Index best = -1;
  double strongest = 0;
  for (Eigen::Index j = 0; j < problem.size(); ++j) {
    const double wish = rise(j) / std::sqrt(problem.matrix(j, j));
    if (is_held(held, j) && wish > strongest + 1e-9 * problem.right.norm()) {
      strongest = wish;
      best = j;
    }
  }
  if (best < 0) return false;
  held[static_cast<std::size_t>(best)] = false;
  return true;
}

}  // namespace

void NormalEquations::add(double weight, std::span<const double> row, double target) {
  const std::size_t n = right.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double weighted = weight * row[i];
    for (std::size_t j = 0; j < n; ++j) matrix[i * n + j] += weighted * row[j];
    right[i] += weighted * target;
  }
}

std::vector<double> bounded_minimum(const NormalEquations& equations, const std::vector<double>& least) {
  const auto n = static_cast<Eigen::Index>(equations.right.size());
  const Problem problem{Eigen::Map<const Eigen::MatrixXd>(equations.matrix.data(), n, n),
                        Eigen::Map<const Eigen::VectorXd>(equations.right.data(), n),
                        Eigen::Map<const Eigen::VectorXd>(least.data(), n)};
  Held held(least.size(), false);
  Eigen::VectorXd at = minimum_with(problem, held);
  // Each change of the set lowers the misfit or mends a bound; the limit is for rounding that cycles.
  for (Eigen::Index round = 0; round < 4 * n; ++round) {
    if (!changed(problem, held, at)) break;
    at = minimum_with(problem, held);
  }
  return {at.data(), at.data() + n};
}

}  // namespace drumlin::coupling
