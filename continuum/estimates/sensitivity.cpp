#include "continuum/estimates/sensitivity.hpp"

#include <ctime>
#include <limits>

namespace drumlin::continuum {
namespace {

Sensitivity to_setting(const std::string& setting, const Regularisation& changed, const FlowCase& flow_case,
                       const FlowSolution& solution, const ScalarSet& unchanged,
                       const FlowSolverOptions& options) {
  FlowProblem problem = flow_case.problem;
  problem.regularisation = changed;
  const std::clock_t begun = std::clock();
  const FlowSolution moved = solve_flow_again(solution.field, problem, options);
  Sensitivity result;
  result.setting = setting;
  result.found = moved.report.converged;
  result.iterations = moved.report.iterations;
  result.cpu_seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  if (!result.found) return result;
  result.changes = difference(flow_case.scalars(moved.field), unchanged);
  result.profile = v_x_change(flow_case.profiles(moved.field), flow_case.profiles(solution.field));
  return result;
}

}  // namespace

std::vector<Sensitivity> sensitivities_of(const FlowCase& flow_case, const FlowSolution& solution,
                                          const std::vector<MeshResult>& meshes,
                                          const FlowSolverOptions& options) {
  const ScalarSet& unchanged = meshes.back().scalars;
  const Regularisation used = flow_case.problem.regularisation;
  Regularisation finer = used, weaker = used;
  finer.shear_rate *= 0.25;
  weaker.pressure *= 0.8;
  // Newton's method takes one step before it looks at its residual.
  FlowSolverOptions once = options;
  once.tolerance = std::numeric_limits<double>::max();
  std::vector<Sensitivity> list = {
      to_setting(finer_shear_rate, finer, flow_case, solution, unchanged, options),
      to_setting(weaker_pressure, weaker, flow_case, solution, unchanged, options),
      to_setting(one_more_iteration, used, flow_case, solution, unchanged, once)};
  Sensitivity mesh;
  mesh.setting = last_halving;
  mesh.profile = std::numeric_limits<double>::quiet_NaN();
  if (meshes.size() > 1) {
    mesh.found = true;
    mesh.changes = difference(unchanged, meshes[meshes.size() - 2].scalars);
  }
  list.push_back(mesh);
  return list;
}

}  // namespace drumlin::continuum
