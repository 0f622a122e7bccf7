#pragma once
// drumlin-flow of a region: steps in time with a free surface, frame by frame.
#include "apps/flow/flow_options.hpp"
#include "continuum/fem/runtime.hpp"
#include "continuum/model/flow_scene.hpp"

namespace drumlin::apps {

/// Solves a scene whose geometry is a region and writes its results; the exit code. Throws InputError,
/// IoError, NotConvergedError.
int solve_region_scene(const FlowOptions& options, const continuum::FemRuntime& runtime);

}  // namespace drumlin::apps
