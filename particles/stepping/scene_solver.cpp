#include "particles/stepping/scene_solver.hpp"

namespace drumlin::particles {

StepSolver solver_of(const Scene& scene, int threads, World* world) {
  const SolverSettings& asked = scene.solver;
  StepSolver solver;
  solver.name = asked.name;
  solver.rule.tolerance = asked.tolerance;
  solver.rule.penetration = asked.penetration_tolerance;
  solver.rule.sinking = asked.penetration_tolerance;
  solver.rule.max_sweeps = asked.max_sweeps;
  solver.rule.check_every = asked.check_every;
  solver.projection = {asked.projection_sweeps, asked.projection_share.value_or(usual_correction_share)};
  solver.threads = threads;
  solver.world = world;
  return solver;
}

}  // namespace drumlin::particles
