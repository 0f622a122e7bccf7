#include "continuum/fem/scene_options.hpp"

#include <algorithm>

namespace drumlin::continuum {

FlowSolverOptions solver_options(const FlowScene& scene) {
  FlowSolverOptions options;
  options.levels = scene.mesh.levels;
  options.refined_share = scene.mesh.refined_share;
  options.tolerance = scene.solver.tolerance;
  if (options.levels > 2) options.coarse_tolerance = std::max(options.tolerance, 1e-6);
  options.linear_tolerance = scene.solver.linear_tolerance;
  options.max_iterations = scene.solver.max_iterations;
  return options;
}

}  // namespace drumlin::continuum
