#include "particles/solver/stopping_rule.hpp"

#include <cmath>

namespace drumlin::particles {

StoppingRule remaining(const StoppingRule& rule, const SolveReport& spent) {
  StoppingRule left = rule;
  left.max_sweeps -= spent.sweeps;
  left.max_seconds -= spent.seconds;
  return left;
}

SolveReport judged(const StoppingRule& rule, SolveReport report) {
  if (report.status == Status::converged && report.residual.rms > rule.tolerance)
    report.status = Status::out_of_sweeps;
  return report;
}

SolveReport together(const SolveReport& first, const SolveReport& second) {
  SolveReport both = second;
  both.sweeps += first.sweeps;
  both.seconds += first.seconds;
  return both;
}

bool StoppingTest::out_of_time() const {
  return seconds() > rule_.max_seconds || (rule_.interrupted && rule_.interrupted());
}

bool StoppingTest::ends(int sweeps, const ContactResidual& residual, bool finite) {
  report_.sweeps = sweeps;
  report_.residual = residual;
  report_.seconds = seconds();
  if (!finite || std::isnan(residual.rms))
    report_.status = Status::not_finite;
  else if (residual.rms <= rule_.tolerance && residual.penetration <= rule_.penetration &&
           !(residual.sinking > rule_.sinking))  // not known of a problem without bodies
    report_.status = Status::converged;
  else if (sweeps >= rule_.max_sweeps)
    report_.status = Status::out_of_sweeps;
  else if (out_of_time())
    report_.status = Status::out_of_time;
  else
    return false;
  return true;
}

}  // namespace drumlin::particles
