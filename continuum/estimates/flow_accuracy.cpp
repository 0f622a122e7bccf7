#include "continuum/estimates/flow_accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace drumlin::continuum {
namespace {

const Sensitivity* found(const AccuracyEvidence& evidence, const char* setting) {
  for (const Sensitivity& s : evidence.sensitivities)
    if (s.found && s.setting == setting) return &s;
  return nullptr;
}

std::optional<double> change_of(const AccuracyEvidence& evidence, const char* setting,
                                const std::string& scalar) {
  const Sensitivity* s = found(evidence, setting);
  if (s == nullptr) return std::nullopt;
  const double change = std::abs(s->changes.value(scalar));
  return std::isfinite(change) ? std::optional(change) : std::nullopt;
}

std::optional<double> mesh_error(const AccuracyEvidence& evidence, const std::string& scalar) {
  if (evidence.meshes.size() < 2) return std::nullopt;
  const double fine = evidence.meshes.back().scalars.value(scalar);
  const double coarse = evidence.meshes[evidence.meshes.size() - 2].scalars.value(scalar);
  if (evidence.meshes.size() > 2)
    for (const ScalarLimit& s : limits_of(evidence.meshes))
      if (s.name == scalar && s.limit) return std::abs(s.limit->value - fine);
  const double change = std::abs(fine - coarse);
  return std::isfinite(change) ? std::optional(change) : std::nullopt;
}

std::optional<double> law_width(const AccuracyEvidence& evidence, const std::string& scalar) {
  const Scalar* found = evidence.law_band.draws > 0 ? evidence.law_band.scalars.find(scalar) : nullptr;
  return found != nullptr && std::isfinite(found->value) ? std::optional(found->value) : std::nullopt;
}

// Wall time of the solve on its last mesh, as a share of all.
double share_of_last_mesh(const AccuracyEvidence& evidence) {
  const auto& history = evidence.report.history;
  if (history.empty() || !(history.back().seconds > 0)) return 1;
  double before = 0;
  for (const IterationReport& line : history)
    if (line.level < history.back().level) before = line.seconds;
  return 1 - before / history.back().seconds;
}

std::vector<ScalarAccuracy> scalar_accuracies(const AccuracyEvidence& evidence) {
  std::vector<ScalarAccuracy> list;
  for (const Scalar& scalar : evidence.meshes.back().scalars.scalars) {
    if (!std::isfinite(scalar.value)) continue;
    std::optional<double> eps = change_of(evidence, finer_shear_rate, scalar.name);
    if (eps) eps = *eps * 4 / 3;
    list.push_back({scalar.name,
                    scalar.value,
                    {{"mesh", mesh_error(evidence, scalar.name)},
                     {"eps", eps},
                     {"iteration", change_of(evidence, one_more_iteration, scalar.name)}},
                    change_of(evidence, weaker_pressure, scalar.name),
                    law_width(evidence, scalar.name)});
  }
  return list;
}

std::vector<Halving> halvings_of(const FlowScene& scene, const AccuracyEvidence& evidence) {
  std::vector<Halving> list;
  if (evidence.meshes.size() > 1) {
    const double growth = static_cast<double>(evidence.meshes.back().unknowns) /
                          evidence.meshes[evidence.meshes.size() - 2].unknowns;
    list.push_back({"mesh", finer_mesh(scene, evidence.meshes.back().level + 1),
                    evidence.cpu_seconds * (1 + growth * share_of_last_mesh(evidence))});
  }
  if (const Sensitivity* s = found(evidence, finer_shear_rate))
    list.push_back({"eps",
                    {fmt::format("regularisation.shear_rate={:g}", scene.regularisation.shear_rate / 2)},
                    evidence.cpu_seconds + s->cpu_seconds});
  if (const Sensitivity* s = found(evidence, one_more_iteration))
    list.push_back({"iteration", {}, evidence.cpu_seconds + s->cpu_seconds});
  return list;
}

}  // namespace

std::vector<std::string> finer_mesh(const FlowScene& scene, int levels) {
  return {fmt::format("mesh.levels={}", levels + 1),
          fmt::format("mesh.surface_cell={:g}",
                      scene.mesh.surface_cell * std::pow(0.5, levels + 1 - scene.mesh.levels))};
}

std::optional<double> ScalarAccuracy::error() const {
  std::optional<double> sum;
  for (const ErrorPart& part : parts)
    if (part.error) sum = sum.value_or(0) + *part.error;
  return sum;
}

std::string ScalarAccuracy::dominant() const {
  const ErrorPart* largest = nullptr;
  for (const ErrorPart& part : parts)
    if (part.error && (largest == nullptr || *part.error > *largest->error)) largest = &part;
  return largest == nullptr ? "" : largest->source;
}

FlowAccuracy accuracy_of(const FlowScene& scene, const AccuracyEvidence& evidence) {
  if (scene.time) return {};
  return {scalar_accuracies(evidence), halvings_of(scene, evidence)};
}

}  // namespace drumlin::continuum
