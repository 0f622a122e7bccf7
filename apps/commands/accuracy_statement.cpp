#include "apps/commands/accuracy_statement.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "apps/support/json_file.hpp"
#include "apps/support/paper_data.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/input_file.hpp"
#include "coupling/documents/json_shape.hpp"
#include "particles/scene/physics.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char *convergence_format = "drumlin-convergence-1", *cost_format = "drumlin-cost-1";
constexpr double missed_tolerance = 0.5;  // a point of which more steps missed it is none of that tolerance

std::optional<double> number(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

std::optional<coupling::AccuracyRecord::Point> point_of(const Json& settings, const Json& results,
                                                        const Json& scalars) {
  const auto tolerance = number(settings, "tolerance"), step = number(settings, "step_s"),
             seconds = number(results, "cpu_seconds");
  if (!tolerance || !step || !seconds || number(results, "missed_share").value_or(0) > missed_tolerance)
    return std::nullopt;
  coupling::AccuracyRecord::Point point{{*tolerance, *step}, *seconds, {}};
  for (const auto& [name, value] : scalars.items())
    if (value.is_object() && number(value, "value"))
      point.scalars.scalars.push_back({name, *number(value, "value"), number(value, "ci99")});
  return point;
}

/// A record with the scene of its runs.
struct SceneRecord {
  coupling::AccuracyRecord runs;
  particles::Scene scene;
};

/// Nothing if the file is no record; its points may be none.
std::optional<SceneRecord> record_in(const fs::path& file) {
  const std::string text = input_text(file);
  // Most files of the folder are of other formats, and large: they are not parsed.
  if (text.find(convergence_format) == text.npos && text.find(cost_format) == text.npos) return std::nullopt;
  if (!Json::accept(text)) return std::nullopt;
  const Json json = parse_json(text, file.string());
  if (!json.is_object() || !json.contains("format") || !json["format"].is_string()) return std::nullopt;
  const std::string format = json["format"];
  const bool convergence = format == convergence_format;
  if (!(convergence || format == cost_format) || !json.contains("scene")) return std::nullopt;
  if (const auto problems = type_problems(file, json, format); !problems.empty()) throw InputError(problems);
  if (!convergence && json.value("kind", "") != "particles") return std::nullopt;
  // Not within the braces: g++ 12 destroys what stands before it twice if it throws.
  particles::Scene scene = particles::parse_scene(json.at("scene").get<std::string>(), file.string());
  SceneRecord record{{file.filename().string(), {}}, std::move(scene)};
  const auto add = [&](const std::optional<coupling::AccuracyRecord::Point>& point) {
    if (point) record.runs.points.push_back(*point);
  };
  if (convergence) {
    for (const auto& [name, settings] : json.at("settings").items())
      if (!settings.value("another_scene", false)) add(point_of(settings, settings, settings));
  } else {
    for (const Json& point : json.at("points"))
      if (point.contains("statistics"))
        add(point_of(point, point.at("statistics"), point.at("statistics").at("scalars")));
  }
  return record;
}

}  // namespace

coupling::AccuracyRecord accuracy_record(const fs::path& given, const particles::Scene& scene) {
  const fs::path file = fs::is_directory(given) ? given / "cost.json" : given;
  if (!fs::exists(file)) throw InputError(file.string() + ": no such file");
  auto record = record_in(file);
  if (!record || record->runs.points.empty())
    throw InputError(file.string() +
                     ": holds no long runs (allowed: COST/cost.json of drumlin cost --statistics)");
  if (particles::scene_text(particles::physics_of(record->scene)) !=
      particles::scene_text(particles::physics_of(scene)))
    throw InputError(file.string() + ": is of another scene: grains, walls, effects or motions differ");
  return record->runs;
}

std::optional<coupling::AccuracyRecord> shipped_record(const particles::Scene& scene) {
  if (!fs::is_directory(cost_data_folder())) return std::nullopt;
  std::set<fs::path> files;  // in one order everywhere
  for (const auto& entry : fs::directory_iterator(cost_data_folder()))
    if (entry.path().extension() == ".json") files.insert(entry.path());
  const std::string ours = particles::scene_text(particles::physics_of(scene));
  for (const fs::path& file : files) {
    auto record = record_in(file);
    if (record && !record->runs.points.empty() && scene_text(particles::physics_of(record->scene)) == ours)
      return record->runs;
  }
  return std::nullopt;
}

Json to_json(const coupling::AccuracyStatement& statement) {
  const auto error_json = [](const std::optional<coupling::SettingError>& e) {
    return e ? Json{{"error", e->error},
                    {"ci99", e->ci99},
                    {"power", e->power},
                    {"significant", e->significant()}}
             : Json(nullptr);
  };
  Json scalars = Json::object(), halving = Json::object();
  for (const coupling::ScalarStatement& one : statement.scalars) {
    const bool averaged = one.measured.ci99 && std::isfinite(*one.measured.ci99);
    scalars[one.measured.name] = {
        {"averaging", averaged ? Json(*one.measured.ci99) : Json(nullptr)},
        {"solver", error_json(one.solver)},
        {"step", error_json(one.step)},
        {"dominant", one.dominant().empty() ? Json(nullptr) : Json(one.dominant())}};
  }
  for (const coupling::RunHalving& h : statement.halvings)
    halving[h.source] = {{"change", h.change}, {"cpu_seconds", h.cpu_seconds}};
  return {{"record", statement.record.empty() ? Json(nullptr) : Json(statement.record)},
          {"scalars", scalars},
          {"halving", halving}};
}

std::string text_of(const coupling::AccuracyStatement& statement) {
  if (statement.record.empty()) {
    std::string text =
        "accuracy: what solver tolerance and time step leave is not known for this scene (drumlin cost SCENE "
        "--statistics SECONDS -o COST, then --accuracy COST)\n";
    for (const coupling::RunHalving& h : statement.halvings)
      text += fmt::format("  half the intervals: {}, about {:.3g} s of processor time\n", h.change,
                          h.cpu_seconds);
    return text;
  }
  std::string text = fmt::format(
      "accuracy, 99 %: averaging; errors by solver tolerance and time step, from {}\n", statement.record);
  const auto said = [](const std::optional<coupling::SettingError>& e) {
    return e ? fmt::format("{:+.2g} +- {:.2g}{}", e->error, e->ci99, e->significant() ? " *" : "")
             : "not known";
  };
  text += fmt::format("  {:<20} {:>11} {:>11} {:>22} {:>22}  largest\n", "", "value", "averaging", "solver",
                      "step");
  for (const coupling::ScalarStatement& one : statement.scalars) {
    const Scalar& s = one.measured;
    text += fmt::format("  {:<20} {:>11} {:>11} {:>22} {:>22}  {}\n", s.name,
                        std::isfinite(s.value) ? fmt::format("{:.4g}", s.value) : "-",
                        s.ci99 && std::isfinite(*s.ci99) ? fmt::format("+- {:.2g}", *s.ci99) : "-",
                        said(one.solver), said(one.step), one.dominant());
  }
  text += "  (* told from none by the record)\n";
  for (const coupling::RunHalving& h : statement.halvings)
    text += fmt::format("  half the {}: {}, about {:.3g} s of processor time\n",
                        h.source == "averaging" ? "intervals" : "error by the " + h.source, h.change,
                        h.cpu_seconds);
  return text;
}

}  // namespace drumlin::apps
