#pragma once
// The points of a sweep over a particle scene: one state, and what each setting makes of it.
#include <vector>

#include "apps/commands.hpp"
#include "particles/scene/scene.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {

struct ParticleSettings {
  std::string solver;
  double tolerance = 0;
  double step_s = 0;
  bool operator==(const ParticleSettings&) const = default;
};
std::string name_of(const ParticleSettings& settings);

/// Where all points begin: at the beginning of the last stage, or at the end of a finished run.
struct SweepStart {
  Scene scene;  ///< its last stage is the one that is gone through with other settings
  SimulationState state;
};

/// From the run of `from`, or by running the scene up to its last stage; kept in OUTPUT/start.h5. Throws
/// InputError when the run is unfinished or of other grains, walls, effects.
SweepStart sweep_start(const CostOptions& options, const Scene& scene);

/// The scene with these settings, its last stage `seconds` long; more sweeps are allowed where the tolerance
/// is tighter than in the scene.
Scene with_settings(const Scene& scene, const ParticleSettings& settings, double seconds);

/// What a stretch has taken, and where the grains are, at one of its marks.
struct Mark {
  double cpu_seconds = 0;
  std::int64_t steps = 0, sweeps = 0, missed = 0;
  double contact_sweeps = 0;
  double overlap_d = 0;  ///< mean over the steps
  Bodies bodies;
};

constexpr int marks_of_stretch = 3;  ///< after a quarter, half and all of it

/// Goes through the stretch and looks at it after each mark. Throws Interrupted, NotConvergedError when a
/// grain is lost.
std::vector<Mark> marks_along(const SweepStart& start, const ParticleSettings& settings, double seconds,
                              int threads);

}  // namespace drumlin::apps
