#include "continuum/sampling/flow_findings.hpp"

#include <cmath>

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

FlowFindings findings_of(const FlowCase& flow_case, const FlowField& field) {
  FlowFindings findings{.sums = field.integrals({}, flow_case.law_I_max), .checks = flow_case.checks(field)};
  if (flow_case.closed_form) findings.closed_form = flow_case.closed_form(field);
  if (flow_case.geometry == "drum") findings.neglected = neglected_terms(field);
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
