#include "particles/lab/sparse_lu.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <suitesparse/umfpack.h>

#include <array>
#include <cmath>
#include <new>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/machine/system_limits.hpp"

#define DRUMLIN_TEXT_OF(number) #number
#define DRUMLIN_VERSIONED(name, number) name "." DRUMLIN_TEXT_OF(number)

namespace drumlin::particles {
namespace {

/// UMFPACK, loaded when the first matrix comes: it brings BLAS and eight more libraries, whose loading takes
/// longer than a small contact problem, and which only exact solvers ask for.
class Umfpack {
 public:
  static const Umfpack& loaded() {
    static const Umfpack library;
    return library;
  }

  decltype(&umfpack_di_defaults) defaults;
  decltype(&umfpack_di_symbolic) symbolic;
  decltype(&umfpack_di_numeric) numeric;
  decltype(&umfpack_di_solve) solve;
  decltype(&umfpack_di_get_determinant) determinant;
  decltype(&umfpack_di_free_symbolic) free_symbolic;
  decltype(&umfpack_di_free_numeric) free_numeric;

 private:
  static constexpr const char* name = DRUMLIN_VERSIONED("libumfpack.so", UMFPACK_MAIN_VERSION);

  Umfpack() : handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr)
      throw IoError(fmt::format("UMFPACK, which the exact solvers need, cannot be loaded: {}", dlerror()));
    start_blas(handle_, 0);
    find(defaults, "umfpack_di_defaults"), find(symbolic, "umfpack_di_symbolic");
    find(numeric, "umfpack_di_numeric"), find(solve, "umfpack_di_solve");
    find(determinant, "umfpack_di_get_determinant");
    find(free_symbolic, "umfpack_di_free_symbolic"), find(free_numeric, "umfpack_di_free_numeric");
  }

  template <class Function>
  void find(Function& function, const char* symbol) {
    void* const found = dlsym(handle_, symbol);
    if (found == nullptr) throw IoError(fmt::format("{} has no function {}", name, symbol));
    function = reinterpret_cast<Function>(found);
  }

  void* handle_;
};

}  // namespace

struct SparseLu::Factors {
  SparsePattern pattern;
  std::vector<double> values;  // the solutions are refined with them
  std::array<double, UMFPACK_CONTROL> control{};
  void* symbolic = nullptr;
  void* numeric = nullptr;
  const Umfpack& library = Umfpack::loaded();

  ~Factors() {
    library.free_symbolic(&symbolic);
    library.free_numeric(&numeric);
  }
  void solve(int system, std::span<const double> b, std::span<double> x) const {
    library.solve(system, pattern.column_start.data(), pattern.row.data(), values.data(), x.data(), b.data(),
                  numeric, control.data(), nullptr);
  }
};

SparseLu::SparseLu(SparsePattern pattern) : factors_(std::make_unique<Factors>()) {
  Factors& f = *factors_;
  f.pattern = std::move(pattern);
  f.library.defaults(f.control.data());
  f.control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  f.control[UMFPACK_ORDERING] = UMFPACK_ORDERING_AMD;
}

SparseLu::~SparseLu() = default;
SparseLu::SparseLu(SparseLu&&) noexcept = default;

const SparsePattern& SparseLu::pattern() const { return factors_->pattern; }

bool SparseLu::factorise(std::vector<double> values) {
  Factors& f = *factors_;
  f.values = std::move(values);
  f.library.free_numeric(&f.numeric);
  for (const double value : f.values)
    if (!std::isfinite(value)) return false;
  const int size = f.pattern.size();
  const int *start = f.pattern.column_start.data(), *row = f.pattern.row.data();
  int status = UMFPACK_OK;
  if (f.symbolic == nullptr)
    status =
        f.library.symbolic(size, size, start, row, f.values.data(), &f.symbolic, f.control.data(), nullptr);
  if (status == UMFPACK_OK)
    status =
        f.library.numeric(start, row, f.values.data(), f.symbolic, &f.numeric, f.control.data(), nullptr);
  if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
  if (status == UMFPACK_OK) return true;
  f.library.free_numeric(&f.numeric);
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
  factors_->library.determinant(&mantissa, &exponent, factors_->numeric, nullptr);
  return mantissa < 0 ? -1 : 1;
}

}  // namespace drumlin::particles
