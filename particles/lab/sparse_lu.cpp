#include "particles/lab/sparse_lu.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

namespace drumlin::particles {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::Map<const Eigen::VectorXd>;

/// Approximate minimum degree (Amestoy, Davis, Duff 1996); SparseLU wants the inverse of what Eigen's gives.
struct MinimumDegree {
  using PermutationType = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;
  void operator()(const Matrix& matrix, PermutationType& order) const {
    PermutationType inverse;
    Eigen::AMDOrdering<int>()(matrix, inverse);
    order = inverse.inverse();
  }
};

/// Pivots stay on the diagonal where that is so much of the largest entry of its column.
constexpr double least_diagonal = 1e-3;

/// With one step of refinement.
void solve_refined(const auto& matrix, auto&& factors, std::span<const double> right, std::span<double> x) {
  const Vector b(right.data(), static_cast<Eigen::Index>(right.size()));
  const Eigen::VectorXd first = factors.solve(b), better = first + factors.solve(b - matrix * first);
  std::copy(better.begin(), better.end(), x.begin());
}

}  // namespace

struct SparseLu::Factors {
  SparsePattern pattern;
  Matrix matrix;
  Eigen::SparseLU<Matrix, MinimumDegree> lu;
};

SparseLu::SparseLu(SparsePattern pattern) : factors_(std::make_unique<Factors>()) {
  Factors& f = *factors_;
  f.pattern = std::move(pattern);
  const std::vector<double> zeros(f.pattern.row.size());
  f.matrix = Eigen::Map<const Matrix>(f.pattern.size(), f.pattern.size(), static_cast<int>(zeros.size()),
                                      f.pattern.column_start.data(), f.pattern.row.data(), zeros.data());
  f.lu.setPivotThreshold(least_diagonal);
  f.lu.analyzePattern(f.matrix);
}

SparseLu::~SparseLu() = default;
SparseLu::SparseLu(SparseLu&&) noexcept = default;

const SparsePattern& SparseLu::pattern() const { return factors_->pattern; }

bool SparseLu::factorise(const std::vector<double>& values) {
  Factors& f = *factors_;
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
    return false;
  std::copy(values.begin(), values.end(), f.matrix.valuePtr());
  f.lu.factorize(f.matrix);
  return f.lu.info() == Eigen::Success;
}

void SparseLu::solve(std::span<const double> b, std::span<double> x) const {
  solve_refined(factors_->matrix, factors_->lu, b, x);
}

void SparseLu::solve_transposed(std::span<const double> b, std::span<double> x) const {
  solve_refined(factors_->matrix.transpose(), factors_->lu.transpose(), b, x);
}

}  // namespace drumlin::particles
