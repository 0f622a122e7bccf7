#pragma once
// A stretch of a few steps from one state with other solver settings: what it costs, where the grains end.
#include <functional>
#include <string>
#include <vector>

#include "particles/scene/scene.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {

/// Where all points of a sweep begin.
struct SweepStart {
  Scene scene;  ///< its last stage is the one that is gone through with other settings
  SimulationState state;
};

struct StretchSettings {
  std::string solver;
  double tolerance = 0;  ///< of the residual
  double step_s = 0;     ///< longest time step; a whole number of steps fits into each part
  double length_s = 0;   ///< of the stretch
};

/// The scene with these settings, its last stage as long as the stretch, of so many `parts`; more sweeps are
/// allowed where the tolerance is tighter than in the scene.
Scene with_settings(const Scene& scene, const StretchSettings& settings, double parts = 4);

/// What a stretch has taken, and where the grains are, at one of its marks.
struct Mark {
  double cpu_seconds = 0;
  std::int64_t steps = 0, sweeps = 0, missed = 0;
  double contact_sweeps = 0;
  double overlap_d = 0;  ///< mean over the steps
  Bodies bodies;
};

constexpr int marks_of_stretch = 3;  ///< after a quarter, half and all of it

/// Runs the scene up to its last stage. `after_step` may throw to end it. Throws NotConvergedError when a
/// grain is lost.
SimulationState at_last_stage(const Scene& scene, int threads,
                              const std::function<void(double share_done)>& after_step);

/// Goes through the stretch and looks at it after each mark. `after_step` may throw to end it. Throws
/// NotConvergedError when a grain is lost.
std::vector<Mark> marks_along(const SweepStart& start, const StretchSettings& settings, int threads,
                              const std::function<void()>& after_step);

/// A stretch of a few steps is short for a clock: the least of `first` and some repetitions, processor
/// seconds.
double least_seconds(const SweepStart& start, const StretchSettings& settings, int threads, double first,
                     const std::function<void()>& after_step);

}  // namespace drumlin::particles
