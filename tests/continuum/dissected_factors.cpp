// Factors on several ranks, of matrices that each rank has rows of.
#include "continuum/fem/detail/dissected_factors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "continuum/fem/detail/petsc_check.hpp"

namespace drumlin::continuum::fem {
namespace {

/// Nine-point coupling of a square grid, unsymmetric, with rows by ranks; `reach` grid lines are coupled.
class GridMatrix {
 public:
  GridMatrix(int side, int reach) : side_(side), reach_(reach) {
    const int near = 2 * reach + 1;
    check(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, side * side, side * side, near * near,
                       nullptr, near * near, nullptr, &matrix_),
          "make a matrix");
    fill(0.3);
    check(MatCreateVecs(matrix_, &x_, &b_), "make a vector");
    check(VecDuplicate(b_, &remainder_), "make a vector");
  }
  ~GridMatrix() { VecDestroy(&x_), VecDestroy(&b_), VecDestroy(&remainder_), MatDestroy(&matrix_); }

  /// `nothing`: all entries are zero.
  void fill(double wind, bool nothing = false) {
    PetscInt begin = 0, end = 0;
    check(MatGetOwnershipRange(matrix_, &begin, &end), "fill a matrix");
    for (PetscInt row = begin; row < end; ++row)
      for (int d = -reach_; d <= reach_; ++d)
        for (int e = -reach_; e <= reach_; ++e) {
          const PetscInt line = row / side_ + d, place = row % side_ + e;
          if (line < 0 || line >= side_ || place < 0 || place >= side_) continue;
          double value = d == 0 && e == 0 ? 8.5 : -1 + wind * d - 0.2 * wind * e * std::sin(1.0 * row);
          if (nothing) value = 0;
          check(MatSetValue(matrix_, row, line * side_ + place, value, INSERT_VALUES), "fill a matrix");
        }
    check(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY), "fill a matrix");
    check(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY), "fill a matrix");
  }

  /// ||A x - b|| / ||b|| of what the factors give for a b without symmetry.
  double error_of(DissectedFactors& factors) {
    PetscInt begin = 0, end = 0;
    check(VecGetOwnershipRange(b_, &begin, &end), "fill a vector");
    for (PetscInt k = begin; k < end; ++k)
      check(VecSetValue(b_, k, std::cos(0.7 * k * k), INSERT_VALUES), "fill a vector");
    check(VecAssemblyBegin(b_), "fill a vector"), check(VecAssemblyEnd(b_), "fill a vector");
    EXPECT_TRUE(factors.solve(b_, x_));
    check(MatMult(matrix_, x_, remainder_), "multiply");
    check(VecAXPY(remainder_, -1, b_), "subtract");
    double left = 0, size = 0;
    check(VecNorm(remainder_, NORM_2, &left), "measure"), check(VecNorm(b_, NORM_2, &size), "measure");
    return left / size;
  }
  Mat matrix() const { return matrix_; }

 private:
  int side_, reach_;
  Mat matrix_ = nullptr;
  Vec x_ = nullptr, b_ = nullptr, remainder_ = nullptr;
};

int ranks() {
  int count = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &count);
  return count;
}

TEST(DissectedFactors, SolveOnAnyNumberOfRanks) {
  GridMatrix grid(60, 1);
  DissectedFactors factors;
  if (ranks() > 3) return;  // most of such a small grid would lie between them
  ASSERT_EQ(factors.suits(grid.matrix()), ranks() > 1);
  if (ranks() == 1) return;
  ASSERT_TRUE(factors.factorise(grid.matrix()));
  EXPECT_LT(grid.error_of(factors), 1e-12);
  // The same pattern with other entries, and another matrix.
  grid.fill(-0.8);
  ASSERT_TRUE(factors.suits(grid.matrix()));
  ASSERT_TRUE(factors.factorise(grid.matrix()));
  EXPECT_LT(grid.error_of(factors), 1e-12);
  GridMatrix finer(75, 1);
  ASSERT_TRUE(factors.suits(finer.matrix()));
  ASSERT_TRUE(factors.factorise(finer.matrix()));
  EXPECT_LT(finer.error_of(factors), 1e-12);
}

/// Callers then factorise the whole matrix on all ranks.
TEST(DissectedFactors, GiveUpOnASingularMatrixOnAllRanks) {
  GridMatrix grid(60, 1);
  grid.fill(0.3, true);
  DissectedFactors factors;
  if (!factors.suits(grid.matrix())) return;
  EXPECT_FALSE(factors.factorise(grid.matrix()));
  EXPECT_FALSE(factors.suits(grid.matrix()));
  const GridMatrix other(50, 1);
  EXPECT_TRUE(factors.suits(other.matrix()));
  EXPECT_TRUE(factors.factorise(other.matrix()));
}

TEST(DissectedFactors, AreNotForMatricesOfWhichMostLiesBetweenRanks) {
  DissectedFactors factors;
  const GridMatrix wide(30, 8);
  EXPECT_FALSE(factors.suits(wide.matrix()));
  EXPECT_FALSE(factors.suits(wide.matrix()));
}

}  // namespace
}  // namespace drumlin::continuum::fem
