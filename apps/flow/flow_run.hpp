#pragma once
#include "apps/commands.hpp"

namespace drumlin::apps {

/// Solves the flow of a scene with a law and writes FLOWRUN; needs a FemRuntime. Returns the exit code;
/// throws InputError, NotConvergedError, IoError.
int solve_flow_scene(const FlowOptions& options);

}  // namespace drumlin::apps
