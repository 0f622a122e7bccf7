#include "continuum/postprocessing/flow_findings.hpp"

#include <cmath>
#include <utility>

namespace drumlin::continuum {

std::vector<ScalarLimit> limits_of(const std::vector<MeshResult>& meshes) {
  std::vector<ScalarLimit> list;
  for (const Scalar& scalar : meshes.back().scalars.scalars) {
    std::vector<double> values;
    for (const MeshResult& mesh : meshes) values.push_back(mesh.scalars.value(scalar.name));
    list.push_back({scalar.name, mesh_limit(values)});
  }
  return list;
}

namespace {

double share_of_eps(const FlowFindings& findings, const FlowProblem& problem) {
  const auto& gap = findings.closed_form;
  if (gap && problem.density > 0) return 1 - gap->speed_without_eps / gap->speed;
  return 1 - findings.sums.dissipation / findings.sums.law_dissipation;
}

}  // namespace

FlowFindings findings_of(const FlowCase& flow_case, const FlowField& field, ScalarSet checks) {
  FlowFindings findings{.sums = field.integrals({}, flow_case.law_I_max), .checks = std::move(checks)};
  if (flow_case.closed_form) findings.closed_form = flow_case.closed_form(field);
  if (flow_case.geometry == Geometry::drum) findings.neglected = neglected_terms(field);
  findings.eps_share = share_of_eps(findings, flow_case.problem);
  findings.checks.scalars.push_back({"eps_share", findings.eps_share, {}});
  return findings;
}

double v_x_change(const ProfileSet& without, const ProfileSet& with) {
  const auto &a = without.column("v_x").value, &b = with.column("v_x").value;
  double change = 0, size = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    change += (a[i] - b[i]) * (a[i] - b[i]);
    size += b[i] * b[i];
  }
  return std::sqrt(change / size);
}

ScalarSet difference(const ScalarSet& changed, const ScalarSet& unchanged) {
  ScalarSet result;
  for (const Scalar& scalar : unchanged.scalars)
    result.scalars.push_back({scalar.name, changed.value(scalar.name) - scalar.value, {}});
  return result;
}

}  // namespace drumlin::continuum
