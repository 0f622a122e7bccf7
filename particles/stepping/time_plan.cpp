#include "particles/stepping/time_plan.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin::particles {

TimePlan time_plan(const Scene& scene, const Scales& scales, std::span<const StageEnd> ends) {
  TimePlan plan;
  for (std::size_t k = 0; k < scene.stages.size(); ++k) {
    const Stage& stage = scene.stages[k];
    const double duration = duration_s(stage);
    const auto steps = std::max<std::int64_t>(1, std::llround(steps_of(stage)));
    const std::int64_t done = k < ends.size() ? std::min(ends[k].steps, steps) : steps;
    const auto add = [&plan](std::int64_t at) {
      if (plan.snapshot_steps.empty() || at > plan.snapshot_steps.back()) plan.snapshot_steps.push_back(at);
    };
    for (std::int64_t s = 1; s <= stage.snapshots; ++s) {
      const auto at = (s * steps + stage.snapshots / 2) / stage.snapshots;
      if (at <= done) add(plan.steps + at);
    }
    if (stage.snapshots > 0 && done < steps) add(plan.steps + done);
    plan.stages.push_back({done, duration / static_cast<double>(steps) / scales.time_s});
    plan.steps += done;
  }
  return plan;
}

}  // namespace drumlin::particles
