#include "apps/flow/flow_sensitivity.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <limits>

namespace drumlin::apps {
namespace {

ScalarSet difference(const ScalarSet& changed, const ScalarSet& unchanged) {
  ScalarSet result;
  for (const Scalar& scalar : unchanged.scalars)
    result.scalars.push_back({scalar.name, changed.value(scalar.name) - scalar.value, {}});
  return result;
}

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

std::string sensitivity_text(const FinishedFlow& flow) {
  if (flow.sensitivities.empty()) return "";
  std::string text = fmt::format("{:<14} {:>11}", "changes by", "value");
  for (const Sensitivity& s : flow.sensitivities) text += fmt::format(" {:>26}", s.setting);
  text += "\n";
  for (const Scalar& scalar : flow.meshes.back().scalars.scalars) {
    text += fmt::format("  {:<12} {:>11.5g}", scalar.name, scalar.value);
    for (const Sensitivity& s : flow.sensitivities)
      text +=
          s.found ? fmt::format(" {:>+26.2g}", s.changes.value(scalar.name)) : fmt::format(" {:>26}", "-");
    text += "\n";
  }
  text += fmt::format("  {:<12} {:>11}", "v_x, L2", "");
  for (const Sensitivity& s : flow.sensitivities)
    text += s.found && std::isfinite(s.profile) ? fmt::format(" {:>24.2g} %", 100 * s.profile)
                                                : fmt::format(" {:>26}", "-");
  text += fmt::format("\n  {:<12} {:>11}", "iterations", "");
  for (const Sensitivity& s : flow.sensitivities) text += fmt::format(" {:>26}", s.iterations);
  return text + "\n";
}

}  // namespace drumlin::apps
