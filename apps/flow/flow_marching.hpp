#pragma once
// A drum through time ([time] of a flow scene): series.csv, kept states, going on from one.
#include <functional>
#include <optional>

#include "apps/commands.hpp"
#include "apps/flow/flow_state_file.hpp"
#include "continuum/fem/flow_solver.hpp"
#include "continuum/fem/runtime.hpp"
#include "continuum/sampling/flow_case.hpp"

namespace drumlin::apps {

/// What a march is made of.
struct MarchPlan {
  std::filesystem::path folder;
  FlowTime time;
  double time_unit_s = 1;  ///< sqrt(d/g)
  double rotation_rpm = 0;
  FlowCheckpoint start;  ///< zero steps: no cells stand for rest, others for the state to start from
  std::string said;      ///< "rest", or the folder whose flow it starts from
  std::function<FlowCase(double share)> case_at;  ///< at a share of the speed of rotation
  FlowSolverOptions options;
};

/// Where a march begins: at the kept state of an interrupted one (`resume`), at the flow of another run, or
/// at rest. Throws InputError for a kept state of another scene or law, and for a flow that is no drum's.
FlowCheckpoint march_start(const FlowOptions& options, const FlowScene& scene, const std::string& scene_text,
                           const std::string& law_text);

/// Marches to the end; after every time.every steps the first rank leaves series.csv and checkpoint.h5, and
/// the march goes on from what it kept, so that one that is resumed has the same bits (on one rank). The
/// report is that of the steps done here. Collective.
FlowSolution march_scene(const MarchPlan& plan, const FemRuntime& runtime, const FlowObserver& observer);

}  // namespace drumlin::apps
