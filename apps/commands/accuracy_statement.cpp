#include "apps/commands/accuracy_statement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/support/json_file.hpp"
#include "apps/support/paper_data.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/text_file.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// A step of implicit Euler, and a solve far below its tolerance, err with the first power; a solve that is
// left early may err with a lower one.
const std::vector<double> step_powers = {1}, tolerance_powers = {1, 0.5};
constexpr double missed_tolerance = 0.5;  // a point of which more steps missed it is none of that tolerance

std::optional<double> number(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

std::optional<AccuracyRecord::Point> point_of(const Json& settings, const Json& results,
                                              const Json& scalars) {
  const auto tolerance = number(settings, "tolerance"), step = number(settings, "step_s"),
             seconds = number(results, "cpu_seconds");
  if (!tolerance || !step || !seconds || number(results, "missed_share").value_or(0) > missed_tolerance)
    return std::nullopt;
  AccuracyRecord::Point point{*tolerance, *step, *seconds, {}};
  for (const auto& [name, value] : scalars.items())
    if (value.is_object() && number(value, "value"))
      point.scalars.scalars.push_back({name, *number(value, "value"), number(value, "ci99")});
  return point;
}

/// Nothing if the file is no record; its points may be none.
std::optional<AccuracyRecord> record_in(const fs::path& file) {
  const Json json = Json::parse(file_text(file), nullptr, false);
  if (!json.is_object()) return std::nullopt;
  const std::string format = json.value("format", "");
  const bool convergence = format == "drumlin-convergence-1";
  if (!(convergence || format == "drumlin-cost-1") || !json.contains("scene")) return std::nullopt;
  if (!convergence && json.value("kind", "") != "particles") return std::nullopt;
  AccuracyRecord record{
      file.filename().string(), parse_scene(json.at("scene").get<std::string>(), file.string()), {}};
  const auto add = [&](const std::optional<AccuracyRecord::Point>& point) {
    if (point) record.points.push_back(*point);
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

bool alike(double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); }

/// Points that differ from each other by one setting alone: those that share the other with the scene, and
/// where these are too few, those that share the commonest other one.
template <class Varied, class Shared>
std::vector<const AccuracyRecord::Point*> series_of(const AccuracyRecord& record, Varied varied,
                                                    Shared shared, double scene_shares) {
  std::vector<const AccuracyRecord::Point*> best;
  std::size_t most = 0;
  for (const auto& candidate : record.points) {
    std::vector<const AccuracyRecord::Point*> series;
    std::set<double> settings;
    for (const auto& point : record.points)
      if (alike(shared(point), shared(candidate))) {
        series.push_back(&point);
        settings.insert(varied(point));
      }
    const bool of_scene = alike(shared(candidate), scene_shares) && settings.size() >= 3;
    if (settings.size() > most || of_scene) {
      most = settings.size();
      best = series;
    }
    if (of_scene) break;
  }
  return best;
}

double tolerance_of(const AccuracyRecord::Point& p) { return p.tolerance; }
double step_of(const AccuracyRecord::Point& p) { return p.step_s; }

template <class Varied>
std::optional<SettingError> error_of(const std::vector<const AccuracyRecord::Point*>& series, Varied varied,
                                     const std::string& scalar, double setting,
                                     const std::vector<double>& powers) {
  std::vector<SettingPoint> points;
  for (const auto* point : series)
    if (const Scalar* found = point->scalars.find(scalar))
      points.push_back({varied(*point), found->value, found->ci99.value_or(0)});
  return setting_error(points, setting, powers);
}

/// By what the time grows when the setting is divided by `factor`, from the two points about it, logarithmic
/// in both; below all points like between the lowest two.
template <class Varied>
std::optional<double> growth_of_cost(std::vector<const AccuracyRecord::Point*> series, Varied varied,
                                     double setting, double factor) {
  std::sort(series.begin(), series.end(), [&](auto* a, auto* b) { return varied(*a) < varied(*b); });
  const double target = setting / factor;
  for (std::size_t i = 0; i + 1 < series.size(); ++i) {
    const double low = varied(*series[i]), high = varied(*series[i + 1]);
    if (!(high > low) || (high < target && i + 2 < series.size())) continue;
    const double slope = std::log(series[i]->cpu_seconds / series[i + 1]->cpu_seconds) / std::log(high / low);
    return std::pow(factor, slope);
  }
  return std::nullopt;
}

void add_setting_halving(AccuracyStatement& statement, const char* source, const std::string& words,
                         const std::optional<double>& growth, const RunCost& cost) {
  if (growth && cost.cpu_seconds > 0)
    statement.halvings.push_back({source, words, *growth * cost.cpu_seconds});
}

}  // namespace

Scene physics_of(Scene scene) {
  scene.title.clear();
  scene.seed = 1;
  scene.reduced = false;
  scene.solver = {};
  scene.output = {};
  for (Stage& stage : scene.stages) {
    stage.duration_s = 1;
    stage.turns.reset();
    stage.time_step_s = 1;
    stage.snapshots = 0;
  }
  return scene;
}

AccuracyRecord accuracy_record(const fs::path& given, const Scene& scene) {
  const fs::path file = fs::is_directory(given) ? given / "cost.json" : given;
  if (!fs::exists(file)) throw InputError(file.string() + ": no such file");
  auto record = record_in(file);
  if (!record || record->points.empty())
    throw InputError(file.string() +
                     ": holds no long runs (allowed: COST/cost.json of drumlin cost --statistics)");
  if (scene_text(physics_of(record->scene)) != scene_text(physics_of(scene)))
    throw InputError(file.string() + ": is of another scene: grains, walls, effects or motions differ");
  return *record;
}

std::optional<AccuracyRecord> shipped_record(const Scene& scene) {
  if (!fs::is_directory(cost_data_folder())) return std::nullopt;
  std::set<fs::path> files;  // in one order everywhere
  for (const auto& entry : fs::directory_iterator(cost_data_folder()))
    if (entry.path().extension() == ".json") files.insert(entry.path());
  const std::string ours = scene_text(physics_of(scene));
  for (const fs::path& file : files) {
    auto record = record_in(file);
    if (record && !record->points.empty() && scene_text(physics_of(record->scene)) == ours) return record;
  }
  return std::nullopt;
}

std::string ScalarStatement::dominant() const {
  std::string name;
  double largest = 0;
  const auto offer = [&](const char* source, double error) {
    if (error > largest) name = source, largest = error;
  };
  if (measured.ci99) offer("averaging", *measured.ci99);
  if (solver && solver->significant()) offer("solver", std::abs(solver->error));
  if (step && step->significant()) offer("step", std::abs(step->error));
  return name;
}

AccuracyStatement accuracy_statement(const Scene& scene, const std::optional<AccuracyRecord>& record,
                                     const ScalarSet& measured, const RunCost& cost) {
  AccuracyStatement statement;
  const double tolerance = scene.solver.tolerance, step = scene.stages.back().time_step_s;
  if (cost.sampled_seconds > 0 && cost.simulated_seconds > 0)
    statement.halvings.push_back(
        {"averaging",
         cost.turns > 0
             ? fmt::format("{:.3g} turns in place of {:.3g}", 4 * cost.turns, cost.turns)
             : fmt::format("{:.3g} s in place of {:.3g} s", 4 * cost.sampled_seconds, cost.sampled_seconds),
         cost.cpu_seconds * (1 + 3 * cost.sampled_seconds / cost.simulated_seconds)});
  if (!record) {
    for (const Scalar& scalar : measured.scalars) statement.scalars.push_back({scalar, {}, {}});
    return statement;
  }
  statement.record = record->name;
  const auto by_tolerance = series_of(*record, tolerance_of, step_of, step);
  const auto by_step = series_of(*record, step_of, tolerance_of, tolerance);
  std::optional<double> solver_power, step_power;
  const auto add = [&](const Scalar& scalar) {
    ScalarStatement one{scalar,
                        error_of(by_tolerance, tolerance_of, scalar.name, tolerance, tolerance_powers),
                        error_of(by_step, step_of, scalar.name, step, step_powers)};
    if (one.solver)
      solver_power = std::min(solver_power.value_or(1), one.solver->significant() ? one.solver->power : 1);
    if (one.step) step_power = 1;
    if (one.solver || one.step) statement.scalars.push_back(std::move(one));
  };
  if (!measured.scalars.empty())
    for (const Scalar& scalar : measured.scalars) add(scalar);
  else
    for (const Scalar& scalar : record->points.front().scalars.scalars) add({scalar.name, NAN, {}});
  // The lowest power of those that are significant: what halves that, halves the others at least.
  if (solver_power) {
    const double factor = std::pow(2, 1 / *solver_power);
    add_setting_halving(
        statement, "solver",
        fmt::format("solver.tolerance {:.2g} in place of {:g}", tolerance / factor, tolerance),
        growth_of_cost(by_tolerance, tolerance_of, tolerance, factor), cost);
  }
  if (step_power) {
    const double factor = std::pow(2, 1 / *step_power);
    add_setting_halving(statement, "step",
                        fmt::format("time_step_s {:.2g} in place of {:g}", step / factor, step),
                        growth_of_cost(by_step, step_of, step, factor), cost);
  }
  return statement;
}

Json to_json(const AccuracyStatement& statement) {
  const auto error_json = [](const std::optional<SettingError>& e) {
    return e ? Json{{"error", e->error},
                    {"ci99", e->ci99},
                    {"power", e->power},
                    {"significant", e->significant()}}
             : Json(nullptr);
  };
  Json scalars = Json::object(), halving = Json::object();
  for (const ScalarStatement& one : statement.scalars) {
    const bool averaged = one.measured.ci99 && std::isfinite(*one.measured.ci99);
    scalars[one.measured.name] = {
        {"averaging", averaged ? Json(*one.measured.ci99) : Json(nullptr)},
        {"solver", error_json(one.solver)},
        {"step", error_json(one.step)},
        {"dominant", one.dominant().empty() ? Json(nullptr) : Json(one.dominant())}};
  }
  for (const RunHalving& h : statement.halvings)
    halving[h.source] = {{"change", h.change}, {"cpu_seconds", h.cpu_seconds}};
  return {{"record", statement.record.empty() ? Json(nullptr) : Json(statement.record)},
          {"scalars", scalars},
          {"halving", halving}};
}

std::string text_of(const AccuracyStatement& statement) {
  if (statement.record.empty()) {
    std::string text =
        "accuracy: what solver tolerance and time step leave is not known for this scene (drumlin cost SCENE "
        "--statistics SECONDS -o COST, then --accuracy COST)\n";
    for (const RunHalving& h : statement.halvings)
      text += fmt::format("  half the intervals: {}, about {:.3g} s of processor time\n", h.change,
                          h.cpu_seconds);
    return text;
  }
  std::string text = fmt::format(
      "accuracy, 99 %: averaging; errors by solver tolerance and time step, from {}\n", statement.record);
  const auto said = [](const std::optional<SettingError>& e) {
    return e ? fmt::format("{:+.2g} +- {:.2g}{}", e->error, e->ci99, e->significant() ? " *" : "")
             : "not known";
  };
  text += fmt::format("  {:<20} {:>11} {:>11} {:>22} {:>22}  largest\n", "", "value", "averaging", "solver",
                      "step");
  for (const ScalarStatement& one : statement.scalars) {
    const Scalar& s = one.measured;
    text += fmt::format("  {:<20} {:>11} {:>11} {:>22} {:>22}  {}\n", s.name,
                        std::isfinite(s.value) ? fmt::format("{:.4g}", s.value) : "-",
                        s.ci99 && std::isfinite(*s.ci99) ? fmt::format("+- {:.2g}", *s.ci99) : "-",
                        said(one.solver), said(one.step), one.dominant());
  }
  text += "  (* told from none by the record)\n";
  for (const RunHalving& h : statement.halvings)
    text += fmt::format("  half the {}: {}, about {:.3g} s of processor time\n",
                        h.source == "averaging" ? "intervals" : "error by the " + h.source, h.change,
                        h.cpu_seconds);
  return text;
}

}  // namespace drumlin::apps
