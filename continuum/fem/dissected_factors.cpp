#include "continuum/fem/detail/dissected_factors.hpp"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "continuum/fem/detail/mumps_scaling.hpp"
#include "continuum/fem/detail/petsc_check.hpp"

namespace drumlin::continuum::fem {
namespace {

// Operations of MUMPS on n unknowns of these meshes are about 117 n^1.5 (docs/decisions.md).
// The dense part may take this share of what a rank has of them.
constexpr double operations = 117, most_dense = 0.25;

/// The entries of a vector of this process.
class Entries {
 public:
  explicit Entries(Vec vec) : vec_(vec) {
    PetscInt size = 0;
    check(VecGetLocalSize(vec, &size), "read a vector");
    check(VecGetArray(vec, &first_), "read a vector");
    entries_ = {first_, static_cast<std::size_t>(size)};
  }
  ~Entries() { VecRestoreArray(vec_, &first_); }
  Entries(const Entries&) = delete;
  Entries& operator=(const Entries&) = delete;
  double& operator[](std::size_t k) const { return entries_[k]; }
  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }

 private:
  Vec vec_;
  PetscScalar* first_ = nullptr;
  std::span<double> entries_;
};

/// Which matrix, and with which pattern.
struct Pattern {
  PetscObjectId matrix = 0;
  PetscObjectState entries = 0;
  bool operator==(const Pattern&) const = default;
};

Pattern pattern_of(Mat matrix) {
  Pattern pattern;
  check(PetscObjectGetId(reinterpret_cast<PetscObject>(matrix), &pattern.matrix), "read a matrix");
  check(MatGetNonzeroState(matrix, &pattern.entries), "read a matrix");
  return pattern;
}

}  // namespace

struct DissectedFactors::Objects {
  MPI_Comm ranks = MPI_COMM_NULL;
  Pattern pattern;
  bool suited = false;
  std::vector<PetscInt> between;  // unknowns of all ranks, in order
  PetscInt begin = 0, end = 0;    // own unknowns
  // A rank's part: its own unknowns and all those between, in order. Places in it of its own ones that are
  // not between, and their places among all own ones; places of those between.
  std::vector<std::size_t> own, shared;
  std::vector<PetscInt> own_number;
  IS part = nullptr;
  Mat* sub = nullptr;              // the matrix of the part
  std::vector<std::size_t> twice;  // entries of it between unknowns between, which one rank alone keeps
  Mat factors = nullptr, dense = nullptr;
  Vec right = nullptr, left = nullptr, few_right = nullptr, few_left = nullptr;

  ~Objects() { clear(); }
  void clear();
  bool all(bool own_success) const;
  void find_between(Mat matrix);
  void cut_out(Mat matrix);
  void lay_out(Mat matrix);
  void find_twice();
  bool make_factors();
  bool factorise_own();
  bool add_complements();
  bool eliminate();
  void add(std::vector<double>& numbers) const { dealii::Utilities::MPI::sum(numbers, ranks, numbers); }
};

/// Whether all ranks have succeeded: what one rank meets alone must not be thrown there alone.
bool DissectedFactors::Objects::all(bool own_success) const {
  return dealii::Utilities::MPI::min(own_success ? 1 : 0, ranks) == 1;
}

void DissectedFactors::Objects::clear() {
  if (sub) MatDestroySubMatrices(1, &sub);
  sub = nullptr;
  MatDestroy(&factors), MatDestroy(&dense);
  ISDestroy(&part);
  VecDestroy(&right), VecDestroy(&left), VecDestroy(&few_right), VecDestroy(&few_left);
}

void DissectedFactors::Objects::find_between(Mat matrix) {
  check(MatGetOwnershipRange(matrix, &begin, &end), "read a matrix");
  std::vector<PetscInt> found;
  for (PetscInt row = begin; row < end; ++row) {
    PetscInt count = 0;
    const PetscInt* columns = nullptr;
    check(MatGetRow(matrix, row, &count, &columns, nullptr), "read a matrix");
    bool higher = false;
    for (PetscInt k = 0; k < count; ++k) {
      higher |= columns[k] >= end;
      if (columns[k] < begin) found.push_back(columns[k]);
    }
    if (higher) found.push_back(row);
    check(MatRestoreRow(matrix, row, &count, &columns, nullptr), "read a matrix");
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  between.clear();
  for (const auto& of_rank : dealii::Utilities::MPI::all_gather(ranks, found))
    between.insert(between.end(), of_rank.begin(), of_rank.end());
  std::sort(between.begin(), between.end());
  between.erase(std::unique(between.begin(), between.end()), between.end());
}

/// Own unknowns, and which of them are between ranks.
void DissectedFactors::Objects::cut_out(Mat matrix) {
  find_between(matrix);
  std::vector<PetscInt> numbers(between);
  for (PetscInt d = begin; d < end; ++d)
    if (!std::binary_search(between.begin(), between.end(), d)) numbers.push_back(d);
  std::sort(numbers.begin(), numbers.end());
  own.clear(), own_number.clear(), shared.clear();
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (std::binary_search(between.begin(), between.end(), numbers[k]))
      shared.push_back(k);
    else
      own.push_back(k), own_number.push_back(numbers[k] - begin);
  check(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(numbers.size()), numbers.data(),
                        PETSC_COPY_VALUES, &part),
        "cut a matrix");
}

void DissectedFactors::Objects::lay_out(Mat matrix) {
  const auto size = static_cast<PetscInt>(own.size() + shared.size()),
             few = static_cast<PetscInt>(between.size());
  check(MatCreateSubMatrices(matrix, 1, &part, &part, MAT_INITIAL_MATRIX, &sub), "cut a matrix");
  check(MatCreateSeqDense(PETSC_COMM_SELF, few, few, nullptr, &dense), "lay out a dense matrix");
  for (Vec* vec : {&right, &left}) check(VecCreateSeq(PETSC_COMM_SELF, size, vec), "lay out a vector");
  for (Vec* vec : {&few_right, &few_left}) check(VecCreateSeq(PETSC_COMM_SELF, few, vec), "lay out a vector");
  find_twice();
}

void DissectedFactors::Objects::find_twice() {
  twice.clear();
  if (dealii::Utilities::MPI::this_mpi_process(ranks) == 0) return;
  std::vector<char> is_shared(own.size() + shared.size(), 0);
  for (const std::size_t k : shared) is_shared[k] = 1;
  PetscInt rows = 0;
  const PetscInt *start = nullptr, *columns = nullptr;
  PetscBool done = PETSC_FALSE;
  check(MatGetRowIJ(sub[0], 0, PETSC_FALSE, PETSC_FALSE, &rows, &start, &columns, &done), "read a matrix");
  for (const std::size_t k : shared)
    for (PetscInt e = start[k]; e < start[k + 1]; ++e)
      if (is_shared[columns[e]]) twice.push_back(static_cast<std::size_t>(e));
  check(MatRestoreRowIJ(sub[0], 0, PETSC_FALSE, PETSC_FALSE, &rows, &start, &columns, &done),
        "read a matrix");
}

bool DissectedFactors::Objects::make_factors() {
  if (MatGetFactor(sub[0], MATSOLVERMUMPS, MAT_FACTOR_LU, &factors)) return false;
  std::vector<PetscInt> places(shared.begin(), shared.end());
  IS few = nullptr;
  if (ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(places.size()), places.data(), PETSC_COPY_VALUES,
                      &few))
    return false;
  const PetscErrorCode set = MatFactorSetSchurIS(factors, few);
  ISDestroy(&few);
  return !set && !scale_cheaply(factors) && !MatLUFactorSymbolic(factors, sub[0], nullptr, nullptr, nullptr);
}

bool DissectedFactors::Objects::factorise_own() {
  if (!factors && !make_factors()) return false;
  MatFactorError failed = MAT_FACTOR_OTHER;
  return !MatLUFactorNumeric(factors, sub[0], nullptr) && !MatFactorGetError(factors, &failed) &&
         failed == MAT_FACTOR_NOERROR;
}

/// The Schur complement of all ranks, factored. Returns false if it is singular, for this rank.
bool DissectedFactors::Objects::add_complements() {
  Mat own_part = nullptr;
  MatFactorSchurStatus status;
  check(MatFactorGetSchurComplement(factors, &own_part, &status), "read a Schur complement");
  const double* numbers = nullptr;
  check(MatDenseGetArrayRead(own_part, &numbers), "read a Schur complement");
  std::vector<double> sum(numbers, numbers + between.size() * between.size());
  check(MatDenseRestoreArrayRead(own_part, &numbers), "read a Schur complement");
  check(MatFactorRestoreSchurComplement(factors, &own_part, status), "read a Schur complement");
  add(sum);
  double* to = nullptr;
  check(MatSetUnfactored(dense), "factorise a dense matrix");
  check(MatDenseGetArrayWrite(dense, &to), "factorise a dense matrix");
  std::copy(sum.begin(), sum.end(), to);
  check(MatDenseRestoreArrayWrite(dense, &to), "factorise a dense matrix");
  // A singular matrix is an error to PETSc, and would be told of.
  check(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr), "factorise a dense matrix");
  const PetscErrorCode code = MatLUFactor(dense, nullptr, nullptr, nullptr);
  check(PetscPopErrorHandler(), "factorise a dense matrix");
  return !code;
}

/// left = what own unknowns are for `right`, those between at zero. Returns false if MUMPS fails here.
bool DissectedFactors::Objects::eliminate() {
  // Those of the own unknowns alone.
  if (MatMumpsSetIcntl(factors, 26, 0) || MatSolve(factors, right, left)) return false;
  const Entries entries(left);
  for (const std::size_t k : shared) entries[k] = 0;
  return true;
}

DissectedFactors::DissectedFactors() : petsc_(std::make_unique<Objects>()) {}
DissectedFactors::~DissectedFactors() = default;

bool DissectedFactors::suits(Mat matrix) {
  Objects& p = *petsc_;
  const Pattern pattern = pattern_of(matrix);
  if (pattern == p.pattern) return p.suited;
  p.clear();
  p.pattern = {}, p.suited = false;
  check(PetscObjectGetComm(reinterpret_cast<PetscObject>(matrix), &p.ranks), "read a matrix");
  const unsigned int size = dealii::Utilities::MPI::n_mpi_processes(p.ranks);
  PetscInt unknowns = 0;
  check(MatGetSize(matrix, &unknowns, nullptr), "read a matrix");
  bool suited = size > 1;
  if (suited) {
    p.cut_out(matrix);
    const auto few = static_cast<double>(p.between.size());
    const double dense = 2.0 / 3 * few * few * few;
    suited =
        few > 0 && dense < most_dense * operations * std::pow(unknowns, 1.5) / size && p.all(!p.own.empty());
  }
  if (suited) p.lay_out(matrix);
  p.pattern = pattern, p.suited = suited;
  return suited;
}

bool DissectedFactors::factorise(Mat matrix) {
  Objects& p = *petsc_;
  check(MatCreateSubMatrices(matrix, 1, &p.part, &p.part, MAT_REUSE_MATRIX, &p.sub), "cut a matrix");
  if (!p.twice.empty()) {
    double* entries = nullptr;
    check(MatSeqAIJGetArray(p.sub[0], &entries), "cut a matrix");
    for (const std::size_t e : p.twice) entries[e] = 0;
    check(MatSeqAIJRestoreArray(p.sub[0], &entries), "cut a matrix");
  }
  if (p.all(p.factorise_own()) && p.all(p.add_complements())) return true;
  forsake();
  return false;
}

void DissectedFactors::forsake() {
  petsc_->suited = false;
  petsc_->clear();
}

bool DissectedFactors::solve(Vec b, Vec x) {
  Objects& p = *petsc_;
  const Entries from(b), to(x);
  {
    const Entries right(p.right);
    std::fill(right.begin(), right.end(), 0.0);
    for (std::size_t k = 0; k < p.own.size(); ++k) right[p.own[k]] = from[p.own_number[k]];
  }
  bool solved = p.eliminate();
  check(MatMult(p.sub[0], p.left, p.right), "multiply");
  std::vector<double> few(p.between.size(), 0.0);
  {
    const Entries product(p.right), alone(p.left);
    for (std::size_t k = 0; k < few.size(); ++k) {
      few[k] = -product[p.shared[k]];
      if (p.between[k] >= p.begin && p.between[k] < p.end) few[k] += from[p.between[k] - p.begin];
    }
    for (std::size_t k = 0; k < p.own.size(); ++k) to[p.own_number[k]] = alone[p.own[k]];
  }
  p.add(few);
  {
    const Entries right(p.few_right);
    std::copy(few.begin(), few.end(), right.begin());
  }
  solved = !MatSolve(p.dense, p.few_right, p.few_left) && solved;
  {
    const Entries between(p.few_left), left(p.left);
    std::fill(left.begin(), left.end(), 0.0);
    for (std::size_t k = 0; k < few.size(); ++k) {
      left[p.shared[k]] = between[k];
      if (p.between[k] >= p.begin && p.between[k] < p.end) to[p.between[k] - p.begin] = between[k];
    }
  }
  check(MatMult(p.sub[0], p.left, p.right), "multiply");
  {
    const Entries right(p.right);
    for (const std::size_t k : p.shared) right[k] = 0;
  }
  solved = p.eliminate() && solved;
  const Entries change(p.left);
  for (std::size_t k = 0; k < p.own.size(); ++k) to[p.own_number[k]] -= change[p.own[k]];
  return p.all(solved);
}

}  // namespace drumlin::continuum::fem
