#include "coupling/study/study_run_folder.hpp"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "coupling/common/errors.hpp"
#include "coupling/documents/document.hpp"
#include "coupling/documents/json_document.hpp"
#include "coupling/documents/toml_text.hpp"
#include "coupling/exchange/measured_run.hpp"

namespace drumlin::coupling {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Settings of a measurement that must be the same in all runs; the others are results (the angle of the
/// frame, say).
constexpr const char* compared_settings[] = {
    "slope_isoline_nu",      "slope_half_width_asked", "surface_nu",      "position",
    "slice_width_asked",     "layer_thickness",        "velocity_window", "surface_speed_depth",
    "linear_share",          "decay_window_below_H",   "bulk_margin",     "mu_fit_I",
    "mu_fit_surface_margin", "mu_fit_wall_margin"};

/// Defaults of keys that earlier programs did not know: a scene that names such a value says the same as one
/// without the key.
constexpr std::pair<const char*, const char*> later_defaults[] = {
    {"grains.generated.placement", "\"apart\""}};

/// Whether an entry says no more than its absence. `name`: of the key, with those of its tables.
bool says_nothing(const std::string& name, const Node& node) {
  if (const auto* list = std::get_if<Node::Array>(&node.value)) return list->empty();
  if (std::holds_alternative<Node::Table>(node.value)) return false;
  return std::any_of(std::begin(later_defaults), std::end(later_defaults), [&](const auto& later) {
    return name == later.first && toml_value(node) == later.second;
  });
}

/// A table without the keys that the run's program did not know yet, and those that the scene does not use.
Node without_unused_keys(const std::string& name, const Node& table) {
  const auto* entries = std::get_if<Node::Table>(&table.value);
  if (!entries) return table;
  Node::Table kept;
  for (const Node::Entry& entry : *entries) {
    const std::string own = name + "." + entry.key;
    if (!says_nothing(own, entry.node)) kept.push_back({entry.key, without_unused_keys(own, entry.node)});
  }
  return {kept, table.line, table.column};
}

/// Grains, walls and effects of the scene must agree, the numerics need not. A run from elsewhere has no
/// scene.
void add_scene(StudyRun& run, const fs::path& file) {
  if (!fs::exists(file)) return;
  const Document scene = read_toml(file);
  for (const char* part : {"grains", "effects"})
    if (const Node* node = scene.root.find(part))
      run.identity[part] = toml_text(without_unused_keys(part, *node));
  if (const Node* solver = scene.root.find("solver"))
    if (const Node* tolerance = solver->find("tolerance"))
      run.numerics["solver.tolerance"] = toml_value(*tolerance);
  const Node* stages = scene.root.find("stages");
  const auto* all = stages == nullptr ? nullptr : std::get_if<Node::Array>(&stages->value);
  if (all != nullptr && !all->empty())
    if (const Node* step = all->back().find("time_step_s")) run.numerics["time_step_s"] = toml_value(*step);
}

/// The law without its origin.
std::string text_of_law(Json law) {
  law.erase("fitted_on");
  return law.dump();
}

/// "inertia {}" or "nothing": effects and their keys on one line.
std::string text_of_effects(const fs::path& file) {
  const Document scene = read_toml(file);
  const Node* effects = scene.root.find("effects");
  const auto* table = effects == nullptr ? nullptr : std::get_if<Node::Table>(&effects->value);
  std::string text;
  for (const auto& [name, keys] : table == nullptr ? Node::Table() : *table) {
    if (!text.empty()) text += ", ";
    text += name;
    const auto* values = std::get_if<Node::Table>(&keys.value);
    for (const auto& [key, value] : values == nullptr ? Node::Table() : *values)
      text += " " + key + " = " + toml_value(value);
  }
  return text.empty() ? "nothing" : text;
}

double rotation_rpm_of(const ProfileSet& profiles, const Scales& scales) {
  return profiles.header.rotation.value() / scales.time_s * 30 / std::numbers::pi;
}

}  // namespace

StudyRun read_study_run(const fs::path& folder) {
  MeasuredRun measured = read_measured_run(folder, Unsteady::accept);
  StudyRun run;
  run.name = measured.name;
  run.rotation_rpm = rotation_rpm_of(measured.profiles, measured.scales);
  for (const char* key : {"reduced", "drum_radius", "diameter_m"})
    run.identity[key] = header_text(measured.profiles.header, key).value();
  run.profiles = std::move(measured.profiles);
  run.slices = std::move(measured.slices);
  run.scalars = std::move(measured.scalars);
  run.warnings = std::move(measured.unsteady);
  run.accepted = std::move(measured.accepted);
  const Json settings = read_json(folder / "measured" / "measured.json", "drumlin-measured-1")
                            .value("settings", Json::object());
  for (const char* key : compared_settings)
    if (settings.contains(key)) run.identity[std::string("settings.") + key] = plain_text(settings[key]);
  if (fs::exists(folder / "run.json")) {
    const Json seconds = read_json(folder / "run.json", "drumlin-run-1").value("cpu_seconds", Json());
    if (seconds.is_number()) run.cpu_seconds = seconds.get<double>();
  }
  add_scene(run, folder / "scene.toml");
  return run;
}

StudyFlow read_study_flow(const fs::path& folder) {
  FlowRun read = read_flow_run(folder);
  const Json flow = read_json(folder / "flow.json", "drumlin-flow-run-2");
  const Json settings = flow.value("settings", Json::object());
  const Json law = settings.value("law", Json::object());
  StudyFlow run;
  run.name = read.name;
  run.rotation_rpm = rotation_rpm_of(read.profiles, read.scales);
  run.accepted = std::move(read.accepted);
  run.side = {std::move(read.profiles), std::move(read.scalars), {}};
  if (flow.value("cpu_seconds", Json()).is_number()) run.cpu_seconds = flow["cpu_seconds"].get<double>();
  run.start = plain_text(flow.value("start", Json("not said")));
  for (const Json& fitted : law.value("fitted_on", Json::array()))
    run.fitted_on.push_back(plain_text(fitted));
  run.identity = {{"law", text_of_law(law)}, {"effects", text_of_effects(folder / "flow_scene.toml")}};
  for (const char* key : {"surface_cell", "surface_zone", "levels", "regularisation_shear_rate",
                          "regularisation_pressure", "corner_taper", "slice_width", "layer_thickness"})
    if (settings.contains(key)) run.numerics[key] = plain_text(settings[key]);
  return run;
}

}  // namespace drumlin::coupling
