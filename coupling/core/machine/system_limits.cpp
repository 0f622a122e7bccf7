#include "coupling/core/machine/system_limits.hpp"

#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <array>
#include <cstddef>
#include <string>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {
namespace {

constexpr std::size_t kibibyte = 1 << 10, mebibyte = 1 << 20;
constexpr rlim_t least_stack = 256 * kibibyte;
constexpr int blas_buffer = 128 + 16;  // MiB, with what lies around it

/// B = A^-1 B of BLAS; the lengths of the texts come last.
using Dtrsm = void(const char* side, const char* upper, const char* transposed, const char* unit,
                   const int* rows, const int* columns, const double* alpha, const double* A,
                   const int* rows_of_A, double* B, const int* rows_of_B, std::size_t, std::size_t,
                   std::size_t, std::size_t);

rlim_t limit_of(decltype(RLIMIT_STACK) resource) {
  rlimit limit{};
  return ::getrlimit(resource, &limit) == 0 ? limit.rlim_cur : RLIM_INFINITY;
}

}  // namespace

void require_stack() {
  const rlim_t stack = limit_of(RLIMIT_STACK);
  if (stack < least_stack)
    throw IoError("the stack may not grow beyond " + std::to_string(stack / kibibyte) +
                  " KiB (needed: " + std::to_string(least_stack / kibibyte) + "; ulimit -s)");
}

void require_open_files(int count) {
  const rlim_t files = limit_of(RLIMIT_NOFILE);
  if (files < static_cast<rlim_t>(count))
    throw IoError("no more than " + std::to_string(files) +
                  " files may be open (needed: " + std::to_string(count) + "; ulimit -n)");
}

void require_memory(int mebibytes) {
  const std::size_t bytes = static_cast<std::size_t>(mebibytes) * mebibyte;
  void* const memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
    throw IoError("not enough memory: " + std::to_string(mebibytes) + " MiB more are needed to begin");
  ::munmap(memory, bytes);
}

void start_blas(int mebibytes_more) {
  require_memory(blas_buffer + mebibytes_more);
  auto* const solve = reinterpret_cast<Dtrsm*>(::dlsym(RTLD_DEFAULT, "dtrsm_"));
  if (solve == nullptr) return;  // it has another BLAS within it
  constexpr int size = 4;
  constexpr double one = 1;
  std::array<double, size * size> identity{}, same{};
  for (int k = 0; k < size; ++k) identity[(size + 1) * k] = same[(size + 1) * k] = 1;
  solve("L", "U", "N", "N", &size, &size, &one, identity.data(), &size, same.data(), &size, 1, 1, 1, 1);
}

}  // namespace drumlin
