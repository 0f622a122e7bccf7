#include "continuum/fem/detail/time_step.hpp"

#include <algorithm>

#include "continuum/fem/detail/picard.hpp"

namespace drumlin::continuum::fem {
namespace {

// Where nothing moves yet, or as a rigid body, Newton's method knows no direction of D: a fluid first, then
// the law at smaller and smaller eps.
bool advance_carefully(Newton& newton, const FlowSolverOptions& options, Phase phase, SolvedLevel& level) {
  const double tolerance = phase.tolerance;
  const StressLaw law = phase.setting.law;
  phase.name = "start";
  phase.tolerance = options.phase_tolerance;
  phase.keeps_dual = phase.gives_up = false;
  phase.setting.law = NewtonianLaw{1};
  phase.setting.regularisation.shear_rate =
      std::max(phase.setting.regularisation.shear_rate, options.start_shear_rate);
  if (!run(newton, phase, level)) return false;
  phase.setting.law = law;
  return run(newton, phase, level) && lower_shear_rate(newton, options, tolerance, level);
}

}  // namespace

Stage to_middle(double time_step, bool rate_is_known) {
  if (!rate_is_known) return {.length = 0.5 * time_step};
  return {.length = 0.25 * time_step, .rate = 0.25 * time_step};
}

Stage to_end(double time_step) { return {.length = time_step / 3, .start = -1.0 / 3, .middle = 4.0 / 3}; }

FieldVector from_of(const Stage& stage, const FieldVector& start, const FieldVector& middle,
                    const FieldVector* rate) {
  FieldVector sum = start;
  sum *= stage.start;
  if (stage.middle != 0) sum.add(stage.middle, middle);
  if (stage.rate != 0) sum.add(stage.rate, *rate);
  sum.update_ghost_values();
  return sum;
}

std::shared_ptr<const FieldVector> rate_of(const Stage& stage, const FieldVector& from,
                                           const FieldVector& end) {
  auto rate = std::make_shared<FieldVector>(end);
  rate->add(-1, from);
  *rate *= 1 / stage.length;
  rate->update_ghost_values();
  return rate;
}

bool advance_once(Newton& newton, const FlowSolverOptions& options, const Stage& stage,
                  const FieldVector& from, const FieldVector* rate, const MeshMotion& motion,
                  SolvedLevel& level) {
  const State before = level.state;
  const auto& d = *level.discretisation;
  const bool at_rest = before.solution.l2_norm() == 0;
  // Of a mesh that moves the dual is that of the flow before it moved: material keeps its stress as it turns.
  Phase phase{.name = "time step",
              .setting = final_setting(level.problem),
              .tolerance = options.tolerance,
              .keeps_dual = motion.velocity != nullptr,
              .gives_up = true};
  phase.setting.inertia = InertiaSetting{.time_step = stage.length,
                                         .before = std::make_shared<FieldVector>(from),
                                         .mesh_velocity = motion.velocity,
                                         .passing = motion.passing};
  if (rate) {
    level.state.solution = from;
    level.state.solution.add(stage.length, *rate);
  }
  d.constraints.distribute(level.state.solution);  // what the sides do now
  level.state.solution.update_ghost_values();
  // Of the start of the stage: an error of first order in it. At rest there are no axes to turn against.
  level.state.held = nullptr;
  if (holds_fields(level.problem) && !at_rest)
    level.state.held = held_from(level.problem, d, before, {.linear_tolerance = options.linear_tolerance});
  const State start = level.state;
  if (!at_rest && run(newton, phase, level)) return true;
  if (newton.was_interrupted()) return false;
  level.state = start;
  return advance_carefully(newton, options, phase, level);
}

}  // namespace drumlin::continuum::fem
