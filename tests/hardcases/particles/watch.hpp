#pragma once
// What a run of a hard case did, step by step.
#include "tests/hardcases/hard_case.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin {

struct Watch {
  std::int64_t impacts = 0, impacts_unresolved = 0, contacts = 0;  ///< of all steps
  int steps_not_finite = 0;    ///< with a NaN or infinity in a position or velocity
  int steps_lost = 0;          ///< that report a lost grain
  int steps_missed = 0;        ///< whose solve missed a tolerance
  double largest_kinetic = 0;  ///< energy, of all discs
  double largest_rise = 0;     ///< of the kinetic energy within a step
  double largest_gain = 0;     ///< of a step, relative to its beginning
  double gain = 0;             ///< of the run, relative to its beginning
  double largest_overlap = 0;  ///< of a loaded contact before the projection, d
  double largest_mean_overlap = 0;

  void see(const particles::Bodies&, const particles::StepReport&, double kinetic_before);
};

/// Runs to the end; `each_step` sees the state after each step, and its report if it takes one.
template <class EachStep>
Watch run_watched(test::TestRun& run, EachStep&& each_step) {
  Watch watch;
  const double start = run.kinetic();
  double before = start;
  run.each_step([&](const particles::StepReport& report) {
    watch.see(run.bodies(), report, before);
    before = run.kinetic();
    if constexpr (std::is_invocable_v<EachStep, const particles::StepReport&>)
      each_step(report);
    else
      each_step();
  });
  watch.gain = before / start - 1;
  return watch;
}
inline Watch run_watched(test::TestRun& run) {
  return run_watched(run, [] {});
}

}  // namespace drumlin
