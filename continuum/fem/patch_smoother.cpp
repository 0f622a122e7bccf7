#include "continuum/fem/detail/patch_smoother.hpp"

#include <algorithm>
#include <cmath>

#include "continuum/fem/detail/petsc_check.hpp"

namespace drumlin::continuum::fem {
namespace {

// Of each patch's correction. Whole ones make each other's errors larger: from sweep to sweep up to 70 times
// on the drum at 6 rpm. 0.4 to 0.8 damp; 0.6 and 0.7 take the fewest iterations.
constexpr double damping = 0.6;

// LU factors in place, column by column, the reciprocals of the pivots on the diagonal. No pivoting: the
// velocities come first, whose block is definite, and the pressure last. False at a pivot of zero.
bool factorise_dense(float* a, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k) {
    float* column_k = a + k * n;
    if (!(std::abs(column_k[k]) > 1e-30f)) return false;
    const float reciprocal = 1 / column_k[k];
    column_k[k] = reciprocal;
    for (std::size_t i = k + 1; i < n; ++i) column_k[i] *= reciprocal;
    for (std::size_t j = k + 1; j < n; ++j) {
      float* column_j = a + j * n;
      const float factor = column_j[k];
      if (factor == 0) continue;
      for (std::size_t i = k + 1; i < n; ++i) column_j[i] -= factor * column_k[i];
    }
  }
  return true;
}

void solve_dense(const float* a, std::size_t n, float* x) {
  for (std::size_t k = 0; k < n; ++k) {
    const float* column = a + k * n;
    const float at = x[k];
    for (std::size_t i = k + 1; i < n; ++i) x[i] -= at * column[i];
  }
  for (std::size_t k = n; k-- > 0;) {
    const float* column = a + k * n;
    const float at = x[k] *= column[k];
    for (std::size_t i = 0; i < k; ++i) x[i] -= at * column[i];
  }
}

}  // namespace

PatchSmoother::PatchSmoother(Mat matrix, const std::vector<bool>& is_pressure) {
  const PetscInt* of_other = nullptr;
  check(MatMPIAIJGetSeqAIJ(matrix, &own_, &others_, &of_other), "take the rows of a matrix");
  PetscInt count = 0, others = 0;
  PetscBool done = PETSC_FALSE;
  check(MatGetRowIJ(own_, 0, PETSC_FALSE, PETSC_FALSE, &count, &start_, &column_, &done), "take the rows");
  find_patches(is_pressure);
  rest_.resize(static_cast<std::size_t>(count));
  check(MatGetSize(others_, nullptr, &others), "take the rows");
  check(VecCreateSeq(PETSC_COMM_SELF, others, &remote_), "make a vector");
  IS from = nullptr;
  Vec pattern = nullptr;
  check(ISCreateGeneral(PETSC_COMM_SELF, others, of_other, PETSC_COPY_VALUES, &from), "choose unknowns");
  check(MatCreateVecs(matrix, &pattern, nullptr), "make a vector");
  check(VecScatterCreate(pattern, from, remote_, nullptr, &scatter_), "exchange unknowns");
  VecDestroy(&pattern);
  ISDestroy(&from);
}

PatchSmoother::~PatchSmoother() {
  VecDestroy(&remote_);
  VecScatterDestroy(&scatter_);
}

void PatchSmoother::find_patches(const std::vector<bool>& is_pressure) {
  std::vector<bool> taken(is_pressure.size(), false);
  std::vector<PetscInt> patch;
  std::size_t largest = 0;
  for (std::size_t row = 0; row < is_pressure.size(); ++row) {
    if (!is_pressure[row]) continue;
    patch.clear();
    for (PetscInt k = start_[row]; k < start_[row + 1]; ++k)
      if (!is_pressure[static_cast<std::size_t>(column_[k])]) patch.push_back(column_[k]);
    if (patch.empty()) continue;
    patch.push_back(static_cast<PetscInt>(row));
    for (const PetscInt i : patch) taken[static_cast<std::size_t>(i)] = true;
    unknowns_.insert(unknowns_.end(), patch.begin(), patch.end());
    first_.push_back(unknowns_.size());
    first_factor_.push_back(first_factor_.back() + patch.size() * patch.size());
    largest = std::max(largest, patch.size());
  }
  for (std::size_t row = 0; row < taken.size(); ++row)
    if (!taken[row]) single_.push_back(static_cast<PetscInt>(row));
  local_.resize(largest);
}

bool PatchSmoother::factorise(Mat matrix) {
  check(MatMPIAIJGetSeqAIJ(matrix, &own_, &others_, nullptr), "take the rows of a matrix");
  PetscInt count = 0;
  PetscBool done = PETSC_FALSE;
  check(MatGetRowIJ(own_, 0, PETSC_FALSE, PETSC_FALSE, &count, &start_, &column_, &done), "take the rows");
  check(MatSeqAIJGetArrayRead(own_, &value_), "take the values");
  factors_.assign(first_factor_.back(), 0);
  std::vector<int> place(rest_.size(), -1);
  for (std::size_t p = 0; p + 1 < first_.size(); ++p) {
    const std::size_t n = first_[p + 1] - first_[p];
    const PetscInt* patch = unknowns_.data() + first_[p];
    float* a = factors_.data() + first_factor_[p];
    for (std::size_t i = 0; i < n; ++i) place[static_cast<std::size_t>(patch[i])] = static_cast<int>(i);
    for (std::size_t i = 0; i < n; ++i)
      for (PetscInt k = start_[patch[i]]; k < start_[patch[i] + 1]; ++k)
        if (const int j = place[static_cast<std::size_t>(column_[k])]; j >= 0)
          a[static_cast<std::size_t>(j) * n + i] = static_cast<float>(value_[k]);
    for (std::size_t i = 0; i < n; ++i) place[static_cast<std::size_t>(patch[i])] = -1;
    if (!factorise_dense(a, n)) return false;
  }
  diagonal_.assign(single_.size(), 1);
  for (std::size_t s = 0; s < single_.size(); ++s)
    for (PetscInt k = start_[single_[s]]; k < start_[single_[s] + 1]; ++k)
      if (column_[k] == single_[s] && value_[k] != 0) diagonal_[s] = value_[k];
  return true;
}

void PatchSmoother::relax(std::size_t p, const double* b, double* x) {
  const std::size_t n = first_[p + 1] - first_[p];
  const PetscInt* patch = unknowns_.data() + first_[p];
  for (std::size_t i = 0; i < n; ++i) {
    double left = b[patch[i]];
    for (PetscInt k = start_[patch[i]]; k < start_[patch[i] + 1]; ++k) left -= value_[k] * x[column_[k]];
    local_[i] = static_cast<float>(left);
  }
  solve_dense(factors_.data() + first_factor_[p], n, local_.data());
  for (std::size_t i = 0; i < n; ++i) x[patch[i]] += damping * static_cast<double>(local_[i]);
}

void PatchSmoother::sweep(Vec right, Vec left, bool forwards, bool from_zero) {
  const double* b = nullptr;
  double* x = nullptr;
  check(VecGetArrayRead(right, &b), "relax");
  std::copy(b, b + rest_.size(), rest_.begin());
  check(VecRestoreArrayRead(right, &b), "relax");
  if (!from_zero) {
    check(VecScatterBegin(scatter_, left, remote_, INSERT_VALUES, SCATTER_FORWARD), "relax");
    check(VecScatterEnd(scatter_, left, remote_, INSERT_VALUES, SCATTER_FORWARD), "relax");
    const double *value = nullptr, *remote = nullptr;
    const PetscInt *start = nullptr, *column = nullptr;
    PetscInt count = 0;
    PetscBool done = PETSC_FALSE;
    check(MatGetRowIJ(others_, 0, PETSC_FALSE, PETSC_FALSE, &count, &start, &column, &done), "relax");
    check(MatSeqAIJGetArrayRead(others_, &value), "relax");
    check(VecGetArrayRead(remote_, &remote), "relax");
    for (std::size_t i = 0; i < rest_.size(); ++i)
      for (PetscInt k = start[i]; k < start[i + 1]; ++k) rest_[i] -= value[k] * remote[column[k]];
    check(VecRestoreArrayRead(remote_, &remote), "relax");
    check(MatSeqAIJRestoreArrayRead(others_, &value), "relax");
  }
  check(VecGetArray(left, &x), "relax");
  const std::size_t patches = first_.size() - 1;
  for (std::size_t p = 0; p < patches; ++p) relax(forwards ? p : patches - 1 - p, rest_.data(), x);
  for (std::size_t s = 0; s < single_.size(); ++s) {
    const PetscInt i = single_[s];
    double rest = rest_[static_cast<std::size_t>(i)];
    for (PetscInt k = start_[i]; k < start_[i + 1]; ++k) rest -= value_[k] * x[column_[k]];
    x[i] += rest / diagonal_[s];
  }
  check(VecRestoreArray(left, &x), "relax");
}

}  // namespace drumlin::continuum::fem
