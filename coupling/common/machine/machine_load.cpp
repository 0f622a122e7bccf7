#include "coupling/common/machine/machine_load.hpp"

#include <cmath>
#include <cstdlib>
#include <ctime>

namespace drumlin {

double process_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double load_average() {
  double load[1] = {NAN};
  return getloadavg(load, 1) == 1 ? load[0] : NAN;
}

}  // namespace drumlin
