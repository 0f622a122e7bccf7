#include "apps/commands/run_accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/core/documents/described.hpp"

namespace drumlin::particles {
DRUMLIN_DESCRIBED(StretchChange, change, ci99, error_at_most)
}

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr double share_for_accuracy = 0.05;  // of the simulated time, as a first choice
constexpr double cost_of_three = 5;          // stretches: 1 + 2 by the step + about 2 by the tolerance

/// In per cent of the value: what was told apart from none with its interval, else a bound.
std::string said(const Json& change, double value) {
  const double moved = change.at("change"), ci99 = change.at("ci99"), most = change.at("error_at_most");
  if (!(std::abs(value) > 0)) return fmt::format("at most {:.2g}", most);
  const double percent = 100 / std::abs(value);
  if (std::abs(moved) <= ci99) return fmt::format("at most {:.2g} %", percent * most);
  return fmt::format("changes by {:+.2g} +- {:.2g} %; at most {:.2g} %", percent * moved, percent * ci99,
                     percent * most);
}

}  // namespace

Json to_json(const particles::PairedStretches& stretches) {
  Json quantities = Json::object();
  for (const particles::StretchComparison& one : stretches.quantities)
    quantities[one.quantity] = {{"value", one.value}, {"step", one.step}, {"solver", one.solver}};
  return {{"seconds", stretches.seconds},
          {"cpu_seconds", stretches.cpu_seconds},
          {"cpu_seconds_plain", stretches.cost[0]},
          {"cpu_seconds_half_step", stretches.cost[1]},
          {"cpu_seconds_third_tolerance", stretches.cost[2]},
          {"missed_steps", stretches.missed},
          {"quantities", quantities}};
}

std::string text_of_stretches(const Json& stretches, double cpu_seconds) {
  const double taken = stretches.at("cpu_seconds");
  std::string text = fmt::format(
      "accuracy, 99 %: what half the time step and a third of the tolerance change over {:g} s after the "
      "end, and what "
      "the run's own may be wrong by\n  ({:.3g} s of processor time{})\n",
      stretches.at("seconds").get<double>(), taken,
      cpu_seconds > 0 ? fmt::format(", {:.2g} % of the run's", 100 * taken / cpu_seconds) : "");
  text += fmt::format("  {:<16} {:>11}  {:<46}  {}\n", "", "mean", "error by the time step",
                      "error by the solver");
  for (const auto& [name, one] : stretches.at("quantities").items()) {
    const double value = one.at("value");
    text += fmt::format("  {:<16} {:>11.4g}  {:<46}  {}\n", name, value, said(one.at("step"), value),
                        said(one.at("solver"), value));
  }
  if (const auto missed = stretches.at("missed_steps").get<std::int64_t>(); missed > 0)
    text += fmt::format("  {} of their steps missed a tolerance: the solver's error is larger than told\n",
                        missed);
  return text;
}

std::string price_of_stretches(double cpu_seconds, double simulated_seconds) {
  const double seconds = share_for_accuracy * simulated_seconds;
  if (!(seconds > 0)) return {};
  return fmt::format(
      "  drumlin run ... --accuracy-seconds {:.2g} tells them for about {:.2g} s of processor time more\n",
      seconds, cost_of_three * share_for_accuracy * cpu_seconds);
}

}  // namespace drumlin::apps
