#include "continuum/estimates/flow_limits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "continuum/estimates/flow_accuracy.hpp"
#include "continuum/fem/scene_options.hpp"

namespace drumlin::continuum {
namespace {

// Share of Q that the surface lets through.
double leak_share(const FlowCase& flow_case, const ScalarSet& checks) {
  return flow_case.problem.density * checks.value("surface_leak") / checks.value("Q_expected");
}

bool leaks(const FlowCase& flow_case, const ScalarSet& checks) {
  return leak_share(flow_case, checks) > 0.5 * largest_flux_imbalance;
}

std::string cause_of_imbalance(const FlowScene& scene, const FlowCase& flow_case, int levels,
                               const FlowFindings& findings, const FlowOnFinerMeshes& finer) {
  if (leaks(flow_case, findings.checks))
    return fmt::format("the surface lets {:.2g} of Q through: give a larger boundary.surface_stiffness",
                       leak_share(flow_case, findings.checks));
  const std::string halved = fmt::format("{}", fmt::join(finer_mesh(scene, levels), ", "));
  if (scene.time) return "steps in time stay on one mesh: give " + halved;
  std::string text;
  if (!finer.failure.empty())
    text = fmt::format("on cells half as large the flow does not converge ({})", finer.failure);
  else if (finer.imbalance.size() > 1 && finer.imbalance.back() > 0.5 * finer.imbalance.front())
    text = "smaller cells do not lessen it";
  else
    return "give " + halved;
  if (findings.ill_posed_share() > 0)
    return text +
           fmt::format(
               ", and {:.2g} % of the area is ill-posed, where a flow depends on its mesh: give a larger "
               "regularisation.pressure, or a law that is well-posed (docs/theory/rheology.md)",
               100 * findings.ill_posed_share());
  return text + ": a slower drum, or a larger regularisation.pressure, may have a flow that is one";
}

// Of the speed at the top of a layer, or of the stress that the walls meet.
std::string eps_text(const FlowScene& scene, const FlowFindings& findings, bool is_driven_by_weight) {
  const std::string eps = fmt::format("eps = {:g} sqrt(g/d)", scene.regularisation.shear_rate);
  const char* help = "give a smaller regularisation.shear_rate";
  if (!is_driven_by_weight)
    return fmt::format(
        "{} {}, which takes away {:.0f} % of the strength that the law has at these shear rates (at most "
        "{:g} %): {}",
        findings.eps_share > most_creep_share ? "does not flow, but creeps as a fluid of the viscosity of"
                                              : "flows hardly faster than",
        eps, 100 * findings.eps_share, 100 * largest_eps_share, help);
  const GapComparison& gap = findings.closed_form.value();
  if (findings.eps_share > most_creep_share)
    return fmt::format(
        "does not flow: {} lets the layer creep at {:.2g} sqrt(g d), by the law alone it moves at {:.2g}",
        eps, gap.speed, gap.speed_without_eps);
  return fmt::format("{:.0f} % of the speed is a creep that {} lets in (at most {:g} %): {}",
                     100 * findings.eps_share, eps, 100 * largest_eps_share, help);
}

}  // namespace

FlowOnFinerMeshes add_meshes(const FlowScene& scene, const FlowCase& flow_case, FlowSolution& solution,
                             const FlowObserver& observer,
                             const std::function<void(double imbalance)>& adding) {
  FlowOnFinerMeshes finer{.imbalance = {}, .failure = {}, .checks = flow_case.checks(solution.field)};
  if (flow_case.geometry != Geometry::drum) return finer;
  const FlowSolverOptions options = solver_options(scene);
  for (;;) {
    finer.imbalance.push_back(finer.checks.value("flux_imbalance"));
    const bool may_add = !scene.time && scene.mesh.refined_share == 1 &&
                         solution.report.meshes < options.levels + options.further_levels &&
                         4 * solution.field.unknowns() <= most_added_unknowns;
    if (finer.imbalance.back() < largest_flux_imbalance || !may_add || leaks(flow_case, finer.checks))
      return finer;
    adding(finer.imbalance.back());
    FlowSolution next = solve_flow_finer(solution, flow_case.problem, options, observer);
    if (!next.report.converged) {
      finer.failure = next.report.failure;
      solution.report.history = std::move(next.report.history);
      return finer;
    }
    solution = std::move(next);
    finer.checks = flow_case.checks(solution.field);
  }
}

std::vector<std::string> missed_limits(const FlowScene& scene, const FlowCase& flow_case,
                                       const std::vector<MeshResult>& meshes, const FlowFindings& findings,
                                       const FlowOnFinerMeshes& finer) {
  std::vector<std::string> missed;
  if (!finer.imbalance.empty() && !(finer.imbalance.back() < largest_flux_imbalance))
    missed.push_back(
        fmt::format("flux_imbalance is {:.2g} of Q, at most {:g} may be (mesh by mesh: {:.2g}): {}",
                    finer.imbalance.back(), largest_flux_imbalance, fmt::join(finer.imbalance, ", "),
                    cause_of_imbalance(scene, flow_case, meshes.back().level + 1, findings, finer)));
  if (const Scalar* theta = meshes.back().scalars.find("theta_deg");
      theta != nullptr && !(theta->value > 0 && theta->value < 90))
    missed.push_back(fmt::format(
        "a slope of {:.1f} deg is none of a free surface, which hangs over from 90 deg on: give a smaller "
        "regularisation.pressure, which holds the material together, or a slower drum",
        theta->value));
  // Steps in time may begin at rest.
  if (!scene.time && !(findings.eps_share <= largest_eps_share))
    missed.push_back(
        eps_text(scene, findings, findings.closed_form.has_value() && flow_case.problem.density > 0));
  return missed;
}

}  // namespace drumlin::continuum
