#include "apps/commands/cost/flow_points.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/support/child_process.hpp"
#include "apps/support/json_file.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json numbers_or_null(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
  return list;
}

Json results_of(const fs::path& folder) {
  const Json flow = read_json(folder / "flow.json", "drumlin-flow-run-1");
  Json point;
  for (const char* key :
       {"geometry", "unknowns", "iterations", "seconds", "cpu_seconds", "start", "settings"})
    point[key] = flow.at(key);
  Json scalars = Json::object();
  for (const auto& [key, value] : flow.at("meshes").back().items())
    if (key != "cells" && key != "unknowns") scalars[key] = value;
  point["scalars"] = scalars;
  if (flow.at("closed_form").is_object()) {
    point["closed_form"] = {{"v_x", flow.at("closed_form").at("closed_form_error")},
                            {"v_x_mesh", flow.at("closed_form").at("mesh_error")},
                            {"scalars", flow.at("closed_form").at("scalars")}};
  }
  const ProfileSet profiles = read_profiles(folder / "profiles.csv");
  point["profile"] = {{"z", profiles.z}, {"v_x", numbers_or_null(profiles.column("v_x").value)}};
  return point;
}

double profile_difference(const Json& point, const Json& reference) {
  const Json &a = point.at("profile").at("v_x"), &b = reference.at("profile").at("v_x");
  if (a.size() != b.size()) return NAN;
  double change = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!a[i].is_number() || !b[i].is_number()) continue;
    change += std::pow(a[i].get<double>() - b[i].get<double>(), 2);
    size += std::pow(b[i].get<double>(), 2);
  }
  return std::sqrt(change / size);
}

}  // namespace

Json solved_point(const PointStore& store, const FlowToSolve& flow) {
  if (const auto done = store.finished(flow.name)) return *done;
  stop_if_interrupted();
  const fs::path folder = store.beside(flow.name);
  fs::remove_all(folder);  // of a call that was cut off
  std::vector<std::string> words = {
      flow.scene.string(), "--rheology", flow.rheology.string(), "--law-draws", "0", "-o", folder.string()};
  for (const char* change : {"solver.sensitivity=false", "output.figures=false"})
    words.insert(words.end(), {"--set", change});
  for (const std::string& change : flow.changes) words.insert(words.end(), {"--set", change});
  Json point{{"changes", flow.changes}, {"load_before", load_average()}};
  const int code = run_for_lines(program_beside("drumlin-flow"), words, [](const std::string&) {});
  switch (code) {
    case static_cast<int>(ExitCode::done):
      point.update(results_of(folder));
      break;
    case static_cast<int>(ExitCode::not_converged):
      point["failure"] = "the flow did not converge";
      point["cpu_seconds"] = nullptr;
      break;
    case static_cast<int>(ExitCode::wrong_input):
      throw InputError(flow.name + ": drumlin-flow refused the scene or the law");
    case static_cast<int>(ExitCode::interrupted):
    case static_cast<int>(ExitCode::terminated):
      throw Interrupted{code};
    default:
      throw IoError(fmt::format("{}: drumlin-flow ended with exit code {}", flow.name, code));
  }
  store.keep(flow.name, point);
  fs::remove_all(folder);
  return store.finished(flow.name).value();
}

std::vector<std::pair<std::string, double>> scalars_of(const Json& point) {
  std::vector<std::pair<std::string, double>> list;
  for (const auto& [key, value] : point.at("scalars").items())
    if (value.is_number()) list.emplace_back(key, value.get<double>());
  return list;
}

Json relative_differences(const Json& point, const Json& reference) {
  Json differences = Json::object();
  for (const auto& [name, value] : scalars_of(reference)) {
    const auto here = point.at("scalars").find(name);
    if (value != 0 && here != point.at("scalars").end() && here->is_number())
      differences[name] = std::abs(here->get<double>() / value - 1);
  }
  const double profile = profile_difference(point, reference);
  differences["v_x"] = std::isfinite(profile) ? Json(profile) : Json(nullptr);
  return differences;
}

}  // namespace drumlin::apps
