#include "tests/hardcases/particles/watch.hpp"

#include <cmath>

namespace drumlin {

void Watch::see(const particles::Bodies& bodies, const particles::StepReport& report, double kinetic_before) {
  bool finite = true;
  for (const auto* values : {&bodies.x, &bodies.z, &bodies.v_x, &bodies.v_z, &bodies.spin})
    for (const double value : *values) finite = finite && std::isfinite(value);
  steps_not_finite += !finite;
  impacts_unresolved += report.impacts_unresolved;
  impacts += report.impacts, contacts += report.contacts;
  steps_lost += report.lost.has_value();
  steps_missed += report.contacts > 0 && report.solve.status != particles::Status::converged;
  const double kinetic = kinetic_energy(bodies);
  largest_kinetic = larger(largest_kinetic, kinetic);
  largest_rise = larger(largest_rise, kinetic - kinetic_before);
  largest_gain = larger(largest_gain, kinetic / kinetic_before - 1);
  largest_overlap = larger(largest_overlap, report.overlap.max);
  largest_mean_overlap = larger(largest_mean_overlap, report.overlap.mean);
}

}  // namespace drumlin
