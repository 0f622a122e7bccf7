#pragma once
// Steps of a scene and at which of them snapshots are due, as far as that is known: a stage that ends when
// something has happened lasts its full time until it has ended.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// What ended a stage.
enum class EndedBy : std::int32_t { its_time, rest, wall, outlet };
constexpr auto names_of(EndedBy) { return std::array{"its time", "at rest", "wall moved", "grains out"}; }

/// A stage that is over.
struct StageEnd {
  std::int64_t steps = 0;
  EndedBy by = EndedBy::its_time;
};

/// Steps of the whole scene and at which of them snapshots are due.
struct TimePlan {
  struct Part {
    std::int64_t steps = 0;
    double time_step = 0;  ///< dimensionless; the stage's step, so adjusted that whole steps fill the stage
  };
  std::vector<Part> stages;
  std::vector<std::int64_t> snapshot_steps;  ///< ascending, counted over the whole run
  std::int64_t steps = 0;
};

/// `ends`: of the first stages, those that are over. One that ended early keeps the snapshots that were due
/// by then, and has one at its end if it has any.
TimePlan time_plan(const Scene& scene, const Scales& scales, std::span<const StageEnd> ends = {});

}  // namespace drumlin::particles
