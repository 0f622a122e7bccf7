#include "apps/commands/accuracy_statement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/json/records.hpp"
#include "apps/output/paper_data.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/json_numbers.hpp"
#include "coupling/core/files/input_file.hpp"
#include "coupling/core/statistics/setting_error.hpp"
#include "particles/scene/physics.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Point = AccuracyRecord::Point;
using Series = std::vector<const Point*>;

constexpr double missed_tolerance = 0.5;  // a point of which more steps missed it is none of that tolerance

enum Setting : std::size_t { tolerance, step };
constexpr std::array<const char*, 2> sources{"solver", "step"};
constexpr std::array<const char*, 2> keys{"solver.tolerance", "time_step_s"};
// A step of implicit Euler, and a solve far below its tolerance, err with the first power; a solve that is
// left early may err with a lower one.
const std::array<std::vector<double>, 2> powers{{{1, 0.5}, {1}}};

void add_point(AccuracyRecord& record, const OrNull<double>& tolerance, const OrNull<double>& step_s,
               const auto& run, const Json& scalars) {
  if (!tolerance.value || !step_s.value || !run.cpu_seconds.value ||
      run.missed_share.value.value_or(0) > missed_tolerance)
    return;
  Point point{{*tolerance.value, *step_s.value}, *run.cpu_seconds.value, {}};
  const auto number = [](const Json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
  };
  for (const auto& [name, scalar] : scalars.items())
    if (const auto value = number(scalar, "value"))
      point.scalars.scalars.push_back({name, *value, number(scalar, "ci99")});
  record.points.push_back(std::move(point));
}

std::string physics_text(const particles::Scene& scene) {
  return particles::scene_text(particles::physics_of(scene));
}

/// A record with what its runs simulate.
struct PhysicsRecord {
  AccuracyRecord runs;
  std::string physics;
};

/// Nothing if the file is no record, or one without points.
std::optional<PhysicsRecord> record_in(const fs::path& file) {
  const std::string text = input_text(file);
  // Most files of the folder are of other formats, and large: they are not parsed.
  const auto mentions = [&](const char* format) { return text.find(format) != text.npos; };
  if (!mentions(ConvergenceRecord::format) && !mentions(CostRecord::format)) return std::nullopt;
  const Json json = Json::parse(text, nullptr, false);
  const Json format = json.is_object() ? json.value("format", Json()) : Json();
  PhysicsRecord record{{file.filename().string(), {}}, {}};
  std::optional<std::string> scene;
  if (format == ConvergenceRecord::format) {
    const auto found = read_record<ConvergenceRecord>(file);
    scene = found.scene;
    for (const auto& [name, run] : found.settings)
      if (!run.another_scene.value_or(false))
        add_point(record.runs, run.tolerance, run.step_s, run, json["settings"][name]);
  } else if (format == CostRecord::format) {
    const auto found = read_record<CostRecord>(file);
    if (found.kind == "particles") scene = found.scene;
    for (const CostRowRecord& point : found.points)
      if (point.statistics)
        add_point(record.runs, point.tolerance, point.step_s, *point.statistics,
                  point.statistics->scalars.json);
  }
  if (!scene || record.runs.points.empty()) return std::nullopt;
  record.physics = physics_text(particles::parse_scene(*scene, file.string()));
  return record;
}

bool alike(double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); }

/// Points that differ from each other by one setting alone: those that share the other with the scene, and
/// where these are too few, those that share the commonest other one.
Series series_of(const AccuracyRecord& record, Setting varied, double scene_shares) {
  const std::size_t shared = 1 - varied;
  Series best;
  std::size_t most = 0;
  for (const Point& candidate : record.points) {
    Series series;
    std::set<double> settings;
    for (const Point& point : record.points)
      if (alike(point.settings[shared], candidate.settings[shared])) {
        series.push_back(&point);
        settings.insert(point.settings[varied]);
      }
    const bool of_scene = alike(candidate.settings[shared], scene_shares) && settings.size() >= 3;
    if (settings.size() > most || of_scene) {
      most = settings.size();
      best = series;
    }
    if (of_scene) break;
  }
  return best;
}

std::optional<statistics::SettingError> error_of(const Series& series, Setting varied,
                                                 const std::string& scalar, double setting) {
  std::vector<statistics::SettingPoint> points;
  for (const Point* point : series)
    if (const Scalar* found = point->scalars.find(scalar))
      points.push_back({point->settings[varied], found->value, found->ci99.value_or(0)});
  return statistics::setting_error(points, setting, powers[varied]);
}

/// By what the time grows when the setting is divided by `factor`, from the two points about it, logarithmic
/// in both; below all points like between the lowest two.
std::optional<double> growth_of_cost(Series series, Setting varied, double setting, double factor) {
  const auto of = [&](const Point* point) { return point->settings[varied]; };
  std::sort(series.begin(), series.end(), [&](auto* a, auto* b) { return of(a) < of(b); });
  const double target = setting / factor;
  for (std::size_t i = 0; i + 1 < series.size(); ++i) {
    const double low = of(series[i]), high = of(series[i + 1]);
    if (!(high > low) || (high < target && i + 2 < series.size())) continue;
    const double slope = std::log(series[i]->cpu_seconds / series[i + 1]->cpu_seconds) / std::log(high / low);
    return std::pow(factor, slope);
  }
  return std::nullopt;
}

/// Four times the averaging halves the intervals.
Json averaging_halving(const RunCost& cost) {
  return {
      {"change", cost.turns > 0 ? fmt::format("{:.3g} turns in place of {:.3g}", 4 * cost.turns, cost.turns)
                                : fmt::format("{:.3g} s in place of {:.3g} s", 4 * cost.sampled_seconds,
                                              cost.sampled_seconds)},
      {"cpu_seconds", cost.cpu_seconds * (1 + 3 * cost.sampled_seconds / cost.simulated_seconds)}};
}

Json error_json(const std::optional<statistics::SettingError>& e) {
  if (!e) return nullptr;
  return {{"error", e->error}, {"ci99", e->ci99}, {"power", e->power}, {"significant", e->significant()}};
}

/// The largest error; of those by solver and step the significant ones alone.
Json dominant(const Json& scalar) {
  Json name;
  double largest = 0;
  const auto offer = [&](const char* source, double error) {
    if (error > largest) name = source, largest = error;
  };
  if (scalar.at("averaging").is_number()) offer("averaging", scalar["averaging"]);
  for (const char* source : sources)
    if (const Json& e = scalar.at(source); e.is_object() && e.at("significant").get<bool>())
      offer(source, std::abs(e.at("error").get<double>()));
  return name;
}

}  // namespace

std::optional<AccuracyRecord> accuracy_record(const std::optional<fs::path>& given,
                                              const particles::Scene& scene) {
  const std::string ours = physics_text(scene);
  if (given) {
    const fs::path file = fs::is_directory(*given) ? *given / "cost.json" : *given;
    if (!fs::exists(file)) throw InputError(file.string() + ": no such file");
    const auto record = record_in(file);
    if (!record)
      throw InputError(file.string() +
                       ": holds no long runs (allowed: COST/cost.json of drumlin cost --statistics)");
    if (record->physics != ours)
      throw InputError(file.string() + ": is of another scene: grains, walls, effects or motions differ");
    return record->runs;
  }
  const std::optional<fs::path> records = cost_data_folder();
  if (!records) return std::nullopt;
  std::set<fs::path> files;  // in one order everywhere
  for (const auto& entry : fs::directory_iterator(*records))
    if (entry.path().extension() == ".json") files.insert(entry.path());
  for (const fs::path& file : files)
    if (const auto record = record_in(file); record && record->physics == ours) return record->runs;
  return std::nullopt;
}

Json accuracy_statement(const particles::Scene& scene, const std::optional<AccuracyRecord>& record,
                        const ScalarSet& measured, const RunCost& cost) {
  Json scalars = Json::object(), halving = Json::object();
  if (cost.sampled_seconds > 0 && cost.simulated_seconds > 0) halving["averaging"] = averaging_halving(cost);
  const std::array<double, 2> settings{scene.solver.tolerance, scene.stages.back().time_step_s};
  std::array<Series, 2> series;
  // The lowest power of those that are significant: what halves that, halves the others at least.
  std::array<std::optional<double>, 2> power;
  if (record)
    for (const Setting s : {tolerance, step}) series[s] = series_of(*record, s, settings[1 - s]);
  const ScalarSet& all = record && measured.scalars.empty() ? record->points.front().scalars : measured;
  for (const Scalar& scalar : all.scalars) {
    const auto ci99 = measured.scalars.empty() ? std::nullopt : scalar.ci99;
    Json one{{"averaging", number_or_null(ci99)}};
    bool is_identified = !record;
    for (const Setting s : {tolerance, step}) {
      const auto error = error_of(series[s], s, scalar.name, settings[s]);
      one[sources[s]] = error_json(error);
      if (!error) continue;
      is_identified = true;
      power[s] = std::min(power[s].value_or(1), error->significant() ? error->power : 1);
    }
    one["dominant"] = dominant(one);
    if (is_identified) scalars[scalar.name] = one;
  }
  for (const Setting s : {tolerance, step}) {
    if (!power[s] || !(cost.cpu_seconds > 0)) continue;
    const double factor = std::pow(2, 1 / *power[s]);
    if (const auto growth = growth_of_cost(series[s], s, settings[s], factor))
      halving[sources[s]] = {
          {"change", fmt::format("{} {:.2g} in place of {:g}", keys[s], settings[s] / factor, settings[s])},
          {"cpu_seconds", *growth * cost.cpu_seconds}};
  }
  return {{"record", record ? Json(record->name) : Json()}, {"scalars", scalars}, {"halving", halving}};
}

std::string text_of(const Json& statement, const ScalarSet& measured) {
  const bool known = statement.at("record").is_string();
  std::string text =
      known ? fmt::format(
                  "accuracy, 99 %: averaging; errors by solver tolerance and time step, from {}\n  {:<20} "
                  "{:>11} "
                  "{:>11} {:>22} {:>22}  largest\n",
                  statement["record"].get<std::string>(), "", "value", "averaging", "solver", "step")
            : "accuracy: for the errors by solver tolerance and time step, drumlin cost SCENE --statistics "
              "SECONDS -o COST, then --accuracy COST\n";
  const auto said = [](const Json& e) {
    return e.is_null() ? "-"
                       : fmt::format("{:+.2g} +- {:.2g}{}", e.at("error").get<double>(),
                                     e.at("ci99").get<double>(), e.at("significant").get<bool>() ? " *" : "");
  };
  for (const auto& [name, one] : statement.at("scalars").items()) {
    if (!known) break;
    const Scalar* value = measured.find(name);
    text += fmt::format(
        "  {:<20} {:>11} {:>11} {:>22} {:>22}  {}\n", name,
        value != nullptr ? fmt::format("{:.4g}", value->value) : "-",
        one.at("averaging").is_number() ? fmt::format("+- {:.2g}", one["averaging"].get<double>()) : "-",
        said(one.at("solver")), said(one.at("step")),
        one.at("dominant").is_string() ? one["dominant"].get<std::string>() : "");
  }
  if (known) text += "  (* told from none by the record)\n";
  for (const auto& [source, half] : statement.at("halving").items())
    text += fmt::format("  half the {}: {}, about {:.3g} s of processor time\n",
                        source == "averaging" ? "intervals" : "error by the " + source,
                        half.at("change").get<std::string>(), half.at("cpu_seconds").get<double>());
  return text;
}

}  // namespace drumlin::apps
