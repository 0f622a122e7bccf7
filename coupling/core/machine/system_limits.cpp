#include "coupling/core/machine/system_limits.hpp"

#include <sys/resource.h>

#include <cstddef>
#include <string>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {
namespace {

constexpr std::size_t kibibyte = 1 << 10;
constexpr rlim_t least_stack = 256 * kibibyte;

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

}  // namespace drumlin
