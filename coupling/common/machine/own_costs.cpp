#include "coupling/common/machine/own_costs.hpp"

#include <sys/resource.h>

namespace drumlin {
namespace {

rusage own_usage() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage;
}

}  // namespace

double own_cpu_seconds() {
  const rusage usage = own_usage();
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double own_peak_memory_mb() { return static_cast<double>(own_usage().ru_maxrss) / 1024; }

}  // namespace drumlin
