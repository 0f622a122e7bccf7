#pragma once
// Options of the flow solver that a scene asks for.
#include "continuum/fem/flow_solver.hpp"
#include "continuum/model/flow_scene.hpp"

namespace drumlin::continuum {

/// Meshes, tolerances and iterations of the scene, the rest as by default. With three meshes or more all are
/// solved to the last tolerance: they show an order, and then differ by their cells alone.
FlowSolverOptions solver_options(const FlowScene& scene);

}  // namespace drumlin::continuum
