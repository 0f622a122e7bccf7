#include "continuum/time_stepping/drum_march.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "continuum/fem/scene_options.hpp"

namespace drumlin::continuum {
namespace {

void add(FlowReport part, FlowReport& whole) {
  for (IterationReport& line : part.history) line.seconds += whole.seconds;
  whole.converged = part.converged;
  whole.failure = part.failure;
  whole.residual = part.residual;
  whole.iterations += part.iterations;
  whole.seconds += part.seconds;
  whole.history.insert(whole.history.end(), part.history.begin(), part.history.end());
  if (whole.phases.empty()) {
    whole.phases = part.phases;
    return;
  }
  for (std::size_t i = 0; i < whole.phases.size(); ++i) {
    whole.phases[i].seconds += part.phases[i].seconds;
    whole.phases[i].times += part.phases[i].times;
  }
}

FlowField first_field(const DrumMarch& march, const FlowProblem& problem) {
  const bool rests = march.start.steps == 0 && march.start.state.cells.empty();
  return rests ? flow_at_rest(problem, march.options)
               : flow_of_state(march.start.state, problem, march.options);
}

FlowScene at_share_of_speed(FlowScene scene, double share) {
  std::get<FlowDrum>(scene.geometry).rotation_rpm *= share;
  return scene;
}

}  // namespace

DrumMarch drum_march(const FlowScene& scene, const RheologyFit& law) {
  return {.time = scene.time.value(),
          .time_unit_s = scales_of(scene).time_s,
          .rotation_rpm = std::get<FlowDrum>(scene.geometry).rotation_rpm,
          .start = {},
          .case_at = [scene, law](double share) { return flow_case(at_share_of_speed(scene, share), law); },
          .options = solver_options(scene)};
}

double speed_share(const DrumMarch& march, double time_s) {
  const double ramp = march.time.ramp_s, begun = march.start.start_share;
  return time_s < ramp ? begun + (1 - begun) * time_s / ramp : 1;
}

FlowSolution march_drum(const DrumMarch& plan, const MarchObserver& observer) {
  const FlowCase last = plan.case_at(1);
  MarchState kept = plan.start;
  MarchStep now{.step = kept.steps, .scalars = {}};
  FlowObserver watching;
  watching.interrupted = observer.interrupted;
  watching.iteration = [&](const IterationReport& line) {
    ++now.iterations;
    now.residual = line.residual;
  };

  FlowMarch march{.time_step = plan.time.step_s / plan.time_unit_s};
  march.boundary = [&](double time) {
    return plan.case_at(speed_share(plan, time * plan.time_unit_s)).problem.boundary;
  };
  march.stepped = [&](double time, const FlowField& field) {
    ++now.step;
    now.time = time;
    now.time_s = time * plan.time_unit_s;
    const double share = speed_share(plan, now.time_s);
    now.rotation_rpm = share * plan.rotation_rpm;
    now.scalars = plan.case_at(share).scalars(field);
    if (observer.stepped) observer.stepped(now);
    now.iterations = 0;
  };

  FlowSolution whole{FlowReport{}, first_field(plan, last.problem)};
  whole.report.start = "transient run from " + plan.start_name;
  while (kept.steps < plan.time.steps) {
    march.first = kept.steps;
    march.steps = std::min(plan.time.every, plan.time.steps - kept.steps);
    FlowSolution part = march_flow(whole.field, last.problem, march, plan.options, watching);
    whole.field = part.field;
    add(part.report, whole.report);
    if (!part.report.converged) {
      whole.report.failure = fmt::format("step {}, {:.4g} s: {}", now.step + 1,
                                         (now.step + 1) * plan.time.step_s, part.report.failure);
      return whole;
    }
    kept.steps += march.steps;
    kept.state = whole.field.state();
    if (observer.kept) observer.kept(kept);
  }
  return whole;
}

}  // namespace drumlin::continuum
