#include "coupling/accuracy/accuracy_statement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace drumlin::coupling {
namespace {

// A step of implicit Euler, and a solve far below its tolerance, err with the first power; a solve that is
// left early may err with a lower one.
const std::vector<double> step_powers = {1}, tolerance_powers = {1, 0.5};

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

double tolerance_of(const AccuracyRecord::Point& p) { return p.settings.tolerance; }
double step_of(const AccuracyRecord::Point& p) { return p.settings.step_s; }

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

/// Four times the averaging halves the intervals.
RunHalving averaging_halving(const RunCost& cost) {
  return {"averaging",
          cost.turns > 0
              ? fmt::format("{:.3g} turns in place of {:.3g}", 4 * cost.turns, cost.turns)
              : fmt::format("{:.3g} s in place of {:.3g} s", 4 * cost.sampled_seconds, cost.sampled_seconds),
          cost.cpu_seconds * (1 + 3 * cost.sampled_seconds / cost.simulated_seconds)};
}

}  // namespace

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

AccuracyStatement accuracy_statement(const RunSettings& settings, const std::optional<AccuracyRecord>& record,
                                     const ScalarSet& measured, const RunCost& cost) {
  AccuracyStatement statement;
  const double tolerance = settings.tolerance, step = settings.step_s;
  if (cost.sampled_seconds > 0 && cost.simulated_seconds > 0)
    statement.halvings.push_back(averaging_halving(cost));
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

}  // namespace drumlin::coupling
