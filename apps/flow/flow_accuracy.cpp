#include "apps/flow/flow_accuracy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/flow/flow_sensitivity.hpp"
#include "apps/flow/law_band.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

const Sensitivity* found(const FinishedFlow& flow, const char* setting) {
  for (const Sensitivity& s : flow.sensitivities)
    if (s.found && s.setting == setting) return &s;
  return nullptr;
}

std::optional<double> change_of(const FinishedFlow& flow, const char* setting, const std::string& scalar) {
  const Sensitivity* s = found(flow, setting);
  if (s == nullptr) return std::nullopt;
  const double change = std::abs(s->changes.value(scalar));
  return std::isfinite(change) ? std::optional(change) : std::nullopt;
}

std::optional<double> mesh_error(const FinishedFlow& flow, const std::string& scalar) {
  if (flow.meshes.size() < 2) return std::nullopt;
  const double fine = flow.meshes.back().scalars.value(scalar);
  const double coarse = flow.meshes[flow.meshes.size() - 2].scalars.value(scalar);
  if (flow.meshes.size() > 2)
    for (const ScalarLimit& s : limits_of(flow.meshes))
      if (s.name == scalar && s.limit) return std::abs(s.limit->value - fine);
  const double change = std::abs(fine - coarse);
  return std::isfinite(change) ? std::optional(change) : std::nullopt;
}

std::optional<double> law_width(const FinishedFlow& flow, const std::string& scalar) {
  const Scalar* found = flow.law_band.draws > 0 ? flow.law_band.scalars.find(scalar) : nullptr;
  return found != nullptr && std::isfinite(found->value) ? std::optional(found->value) : std::nullopt;
}

// Wall time of the solve on its last mesh, as a share of all.
double share_of_last_mesh(const FinishedFlow& flow) {
  const auto& history = flow.solution.report.history;
  if (history.empty() || !(history.back().seconds > 0)) return 1;
  double before = 0;
  for (const IterationReport& line : history)
    if (line.level < history.back().level) before = line.seconds;
  return 1 - before / history.back().seconds;
}

Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

}  // namespace

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

std::vector<ScalarAccuracy> accuracy_of(const FinishedFlow& flow) {
  std::vector<ScalarAccuracy> list;
  if (flow.scene.time) return list;
  for (const Scalar& scalar : flow.meshes.back().scalars.scalars) {
    if (!std::isfinite(scalar.value)) continue;
    std::optional<double> eps = change_of(flow, finer_shear_rate, scalar.name);
    if (eps) eps = *eps * 4 / 3;
    list.push_back({scalar.name,
                    scalar.value,
                    {{"mesh", mesh_error(flow, scalar.name)},
                     {"eps", eps},
                     {"iteration", change_of(flow, one_more_iteration, scalar.name)}},
                    change_of(flow, weaker_pressure, scalar.name),
                    law_width(flow, scalar.name)});
  }
  return list;
}

std::vector<Halving> halvings_of(const FinishedFlow& flow) {
  const FlowScene& scene = flow.scene;
  std::vector<Halving> list;
  if (flow.meshes.size() > 1) {
    const double growth =
        static_cast<double>(flow.meshes.back().unknowns) / flow.meshes[flow.meshes.size() - 2].unknowns;
    list.push_back({"mesh",
                    {fmt::format("mesh.levels={}", scene.mesh.levels + 1),
                     fmt::format("mesh.surface_cell={:g}", scene.mesh.surface_cell / 2)},
                    flow.cpu_seconds * (1 + growth * share_of_last_mesh(flow))});
  }
  if (const Sensitivity* s = found(flow, finer_shear_rate))
    list.push_back({"eps",
                    {fmt::format("regularisation.shear_rate={:g}", scene.regularisation.shear_rate / 2)},
                    flow.cpu_seconds + s->cpu_seconds});
  if (const Sensitivity* s = found(flow, one_more_iteration))
    list.push_back({"iteration", {}, flow.cpu_seconds + s->cpu_seconds});
  return list;
}

Json accuracy_json(const FinishedFlow& flow) {
  const std::vector<ScalarAccuracy> accuracy = accuracy_of(flow);
  if (accuracy.empty()) return nullptr;
  Json scalars = Json::object(), halvings = Json::object();
  for (const ScalarAccuracy& a : accuracy) {
    Json entry{{"value", a.value}, {"error", number_or_null(a.error())}};
    entry["dominant"] = a.dominant().empty() ? Json(nullptr) : Json(a.dominant());
    for (const ErrorPart& part : a.parts) entry[part.source] = number_or_null(part.error);
    entry["p_min_20_percent"] = number_or_null(a.by_p_min);
    entry["law"] = number_or_null(a.by_law);
    scalars[a.name] = std::move(entry);
  }
  for (const Halving& h : halvings_of(flow))
    halvings[h.source] = {{"set", h.changes}, {"cpu_seconds", h.cpu_seconds}};
  return {{"scalars", scalars}, {"halving", halvings}, {"cpu_seconds", flow.cpu_seconds}};
}

std::string accuracy_text(const FinishedFlow& flow) {
  const std::vector<ScalarAccuracy> accuracy = accuracy_of(flow);
  if (accuracy.empty()) return "";
  std::string text = "accuracy: estimated distance to the exact solution of the equations\n";
  std::vector<std::string> dominant;
  for (const ScalarAccuracy& a : accuracy) {
    text += fmt::format("  {:<12} {:>11.5g} {:>12} ", a.name, a.value,
                        a.error() ? fmt::format("+- {:.2g}", *a.error()) : "not known");
    for (const ErrorPart& part : a.parts)
      text +=
          fmt::format(" {} {}", part.source, part.error ? fmt::format("{:.2g}", *part.error) : "not known");
    if (a.by_p_min) text += fmt::format("; model: {:.2g} by 20 % of p_min", *a.by_p_min);
    if (a.by_law) text += fmt::format("{} {:.2g} by the law", a.by_p_min ? "," : "; model:", *a.by_law);
    text += "\n";
    if (!a.dominant().empty() && std::find(dominant.begin(), dominant.end(), a.dominant()) == dominant.end())
      dominant.push_back(a.dominant());
  }
  if (flow.sensitivities.empty())
    text += "  (what is not known: give solver.sensitivity=true, or drumlin cost SCENE)\n";
  for (const Halving& h : halvings_of(flow))
    if (std::find(dominant.begin(), dominant.end(), h.source) != dominant.end())
      text += fmt::format(
          "  half of the error by {}: {}, about {:.2g} s of processor time in place of {:.2g} s\n", h.source,
          h.changes.empty() ? "one more iteration" : fmt::format("{}", fmt::join(h.changes, ", ")),
          h.cpu_seconds, flow.cpu_seconds);
  return text;
}

}  // namespace drumlin::apps
