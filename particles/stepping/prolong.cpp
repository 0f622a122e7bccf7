#include "particles/stepping/prolong.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/validate.hpp"
#include "particles/stepping/time_plan.hpp"

namespace drumlin::particles {
namespace {

constexpr int most_tries = 100;  // lengths; about every second one can be written down
constexpr double most_more_steps = 1e12;

[[noreturn]] void refuse(const std::string& what, const std::string& allowed) {
  throw InputError({InputProblem{"", 0, 0, "--extend", what, allowed}});
}

/// A duration of so many steps whose steps are `step` long to the last bit; none if no number is one.
std::optional<double> duration_of(std::int64_t steps, double step) {
  const auto n = static_cast<double>(steps);
  const double middle = n * step;
  for (const double duration : {middle, std::nextafter(middle, 0.0), std::nextafter(middle, 2 * middle)})
    if (duration / n == step && std::llround(duration / step) == steps) return duration;
  return std::nullopt;
}

void refuse_what_cannot_go_on(const Scene& scene, const TimePlan& plan, const SimulationState& state) {
  const Stage& last = scene.stages.back();
  if (state.step != plan.steps) refuse("requires more of a run that is not finished", "a finished run");
  if (last.until)
    refuse("requires more of a stage that ends when something has happened", "one without until");
  if (last.gravity && last.gravity->ramp)
    refuse("requires more of a stage whose gravity follows a ramp", "one without a ramp");
}

/// What stays in the folder must be a scene: every later command reads it.
void refuse_what_nothing_reads(const Scene& longer) {
  for (const SceneFault& fault : validate(longer))
    refuse(fmt::format("would leave a scene whose {} {}", fault.key, fault.what), fault.allowed);
}

}  // namespace

Scene prolonged(const Scene& scene, double seconds, SimulationState& state) {
  const Scales scales = scales_of(scene);
  const TimePlan plan = time_plan(scene, scales, state.ends);
  refuse_what_cannot_go_on(scene, plan, state);
  Scene longer = scene;
  Stage& stage = longer.stages.back();
  const std::int64_t steps = plan.stages.back().steps;
  const double step = duration_s(stage) / static_cast<double>(steps);
  // The snapshots up to now stay where they are if their number grows in proportion.
  const std::int64_t unit = stage.snapshots > 0 ? steps / std::gcd(steps, std::int64_t{stage.snapshots}) : 1;
  if (!(seconds / step < most_more_steps))
    refuse(fmt::format("is {} s, {:.3g} steps", seconds, seconds / step),
           fmt::format("fewer than {:g} steps", most_more_steps));
  const std::int64_t units =
      std::max<std::int64_t>(1, std::llround(seconds / step / static_cast<double>(unit)));
  std::optional<double> duration;
  std::int64_t all = steps + units * unit;
  for (int tries = 0; !duration && tries < most_tries; ++tries, all += duration ? 0 : unit)
    duration = duration_of(all, step);
  if (!duration)
    refuse(fmt::format("is {} s, and no length near it keeps the time step", seconds), "another");
  stage.duration_s = *duration;
  all = std::llround(*duration / step);
  stage.turns.reset();
  stage.time_step_s = step;
  const std::int64_t snapshots = stage.snapshots * all / steps;
  if (snapshots > most_snapshots)
    refuse(fmt::format("is {} s, which makes {} snapshots of the last stage", seconds, snapshots),
           fmt::format("at most {}", most_snapshots));
  stage.snapshots = static_cast<int>(snapshots);
  if (!state.ends.empty() && state.ends.size() == scene.stages.size()) state.ends.pop_back();
  const TimePlan now = time_plan(longer, scales, state.ends);
  const auto window =
      static_cast<std::int64_t>(std::max<double>(1, std::round(scene.output.velocity_window_s / step)));
  const bool same =
      now.stages.back().time_step == plan.stages.back().time_step &&
      now.snapshot_steps.size() >= plan.snapshot_steps.size() &&
      std::equal(plan.snapshot_steps.begin(), plan.snapshot_steps.end(), now.snapshot_steps.begin());
  if (!same) refuse("would move the snapshots that the run has", "a stage whose snapshots are evenly spread");
  if (scene.output.velocity_window_s > 0 && now.snapshot_steps.size() > plan.snapshot_steps.size() &&
      now.snapshot_steps[plan.snapshot_steps.size()] < plan.steps + window)
    refuse("requires a snapshot whose velocity window began before the end of the run",
           "intervals between snapshots longer than output.velocity_window_s");
  refuse_what_nothing_reads(longer);
  return longer;
}

}  // namespace drumlin::particles
