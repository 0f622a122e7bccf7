#pragma once
// LU factors of sparse matrices with one pattern.
#include <memory>
#include <span>
#include <vector>

namespace drumlin::particles {

/// A square matrix in compressed columns, rows ascending in each.
struct SparsePattern {
  std::vector<int> column_start;  ///< columns + 1 entries
  std::vector<int> row;

  int size() const { return static_cast<int>(column_start.size()) - 1; }
};

/// Factors of matrices of one pattern, by Eigen (Demmel et al. 1999). The pattern should be symmetric: rows
/// and columns are then ordered alike, which keeps the fill of a planar graph. The same matrix gives the same
/// bytes.
class SparseLu {
 public:
  explicit SparseLu(SparsePattern pattern);
  ~SparseLu();
  SparseLu(SparseLu&&) noexcept;
  SparseLu& operator=(SparseLu&&) = delete;

  const SparsePattern& pattern() const;
  /// Entries in the order of the pattern. False if the matrix is singular or an entry is not finite; there
  /// are then no factors.
  bool factorise(const std::vector<double>& values);
  /// Solves A x = b with the last factors.
  void solve(std::span<const double> b, std::span<double> x) const;
  /// Solves A^T x = b.
  void solve_transposed(std::span<const double> b, std::span<double> x) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace drumlin::particles
