#pragma once
// The command `drumlin flow`: reads, solves, writes FLOWRUN.
#include "apps/flow/flow_options.hpp"
#include "continuum/fem/runtime.hpp"

namespace drumlin::apps {

/// Solves the flow of a scene with a law on all ranks and writes FLOWRUN on the first. Returns the exit code;
/// throws InputError, NotConvergedError, IoError.
int solve_flow_scene(const FlowOptions& options, const continuum::FemRuntime& runtime);

}  // namespace drumlin::apps
