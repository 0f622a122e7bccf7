#include "particles/solver/sparse_lu.hpp"

#include <suitesparse/umfpack.h>

#include <array>
#include <cmath>
#include <new>

namespace drumlin::particles {

struct SparseLu::Factors {
  SparsePattern pattern;
  std::vector<double> values;  // the solutions are refined with them
  std::array<double, UMFPACK_CONTROL> control{};
  void* symbolic = nullptr;
  void* numeric = nullptr;

  ~Factors() {
    umfpack_di_free_symbolic(&symbolic);
    umfpack_di_free_numeric(&numeric);
  }
  void solve(int system, std::span<const double> b, std::span<double> x) const {
    umfpack_di_solve(system, pattern.column_start.data(), pattern.row.data(), values.data(), x.data(),
                     b.data(), numeric, control.data(), nullptr);
  }
};

SparseLu::SparseLu(SparsePattern pattern) : factors_(std::make_unique<Factors>()) {
  Factors& f = *factors_;
  f.pattern = std::move(pattern);
  umfpack_di_defaults(f.control.data());
  f.control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  f.control[UMFPACK_ORDERING] = UMFPACK_ORDERING_AMD;
}

SparseLu::~SparseLu() = default;
SparseLu::SparseLu(SparseLu&&) noexcept = default;

const SparsePattern& SparseLu::pattern() const { return factors_->pattern; }

bool SparseLu::factorise(std::vector<double> values) {
  Factors& f = *factors_;
  f.values = std::move(values);
  umfpack_di_free_numeric(&f.numeric);
  for (const double value : f.values)
    if (!std::isfinite(value)) return false;
  const int size = f.pattern.size();
  const int *start = f.pattern.column_start.data(), *row = f.pattern.row.data();
  int status = UMFPACK_OK;
  if (f.symbolic == nullptr)
    status =
        umfpack_di_symbolic(size, size, start, row, f.values.data(), &f.symbolic, f.control.data(), nullptr);
  if (status == UMFPACK_OK)
    status =
        umfpack_di_numeric(start, row, f.values.data(), f.symbolic, &f.numeric, f.control.data(), nullptr);
  if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
  if (status == UMFPACK_OK) return true;
  umfpack_di_free_numeric(&f.numeric);
  return false;
}

void SparseLu::solve(std::span<const double> b, std::span<double> x) const {
  factors_->solve(UMFPACK_A, b, x);
}

void SparseLu::solve_transposed(std::span<const double> b, std::span<double> x) const {
  factors_->solve(UMFPACK_At, b, x);
}

int SparseLu::determinant_sign() const {
  double mantissa = 0, exponent = 0;
  umfpack_di_get_determinant(&mantissa, &exponent, factors_->numeric, nullptr);
  return mantissa < 0 ? -1 : 1;
}

}  // namespace drumlin::particles
