#include "apps/commands/cost/advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "coupling/documents/json_numbers.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

/// NaN where it is not known.
double number_of(const Json& object, const std::string& key) {
  const auto found = object.find(key);
  return found == object.end() ? std::nan("") : number_or_nan(*found).value_or(std::nan(""));
}

double seconds_of(const Json& point) { return number_of(point, "cpu_seconds"); }
double error_of(const Json& point, const std::string& quantity) {
  return number_of(point.at("errors"), quantity);
}

/// Null if no point is as exact as that.
const Json* cheapest(const Json& points, const std::string& quantity, double error) {
  const Json* best = nullptr;
  for (const Json& point : points)
    if (error_of(point, quantity) <= error && std::isfinite(seconds_of(point)) &&
        (!best || seconds_of(point) < seconds_of(*best)))
      best = &point;
  return best;
}

/// The cheapest point that is nowhere less exact; null if the scene is that point.
const Json* beats(const Json& points, const Json& scene, const std::vector<std::string>& quantities) {
  const Json* best = nullptr;
  for (const Json& point : points) {
    const bool as_exact = std::all_of(quantities.begin(), quantities.end(), [&](const std::string& quantity) {
      return !(error_of(point, quantity) > error_of(scene, quantity)) &&
             std::isnan(error_of(point, quantity)) == std::isnan(error_of(scene, quantity));
    });
    if (as_exact && seconds_of(point) < 0.9 * seconds_of(scene) &&
        (!best || seconds_of(point) < seconds_of(*best)))
      best = &point;
  }
  return best;
}

std::string cost_over(const Json& point, const Json& scene) {
  if (point.at("default").get<bool>()) return "the scene as it is";
  return fmt::format("{:.2g} times the scene's", seconds_of(point) / seconds_of(scene));
}

}  // namespace

std::string advice_text(const Json& points, const std::vector<std::string>& quantities,
                        const std::function<std::string(const Json& point)>& lines_of) {
  const auto scene = std::find_if(points.begin(), points.end(),
                                  [](const Json& point) { return point.at("default").get<bool>(); });
  if (scene == points.end() || !std::isfinite(seconds_of(*scene))) return {};
  std::string text = "the cheapest settings of this sweep, by the error that they leave:\n";
  std::map<std::string, std::string> lines;  // by name of a point
  for (const std::string& quantity : quantities) {
    text += fmt::format("  {}:", quantity);
    for (const double error : {0.05, 0.02, 0.01}) {
      const Json* best = cheapest(points, quantity, error);
      text += fmt::format(
          "{} {:g} %: {}", error == 0.05 ? "" : ";", 100 * error,
          best ? fmt::format("{} ({})", best->at("name").get<std::string>(), cost_over(*best, *scene))
               : "none");
      if (best && !best->at("default").get<bool>()) lines[best->at("name")] = lines_of(*best);
    }
    text += "\n";
    if (const double error = error_of(*scene, quantity); error > 0.05)
      text += fmt::format("    the scene as it is leaves {:.2g} %\n", 100 * error);
  }
  if (const Json* better = beats(points, *scene, quantities)) {
    text +=
        fmt::format("the scene as it is wastes time: {} is as exact in all of these at {:.2g} of its cost\n",
                    better->at("name").get<std::string>(), seconds_of(*better) / seconds_of(*scene));
    lines[better->at("name")] = lines_of(*better);
  }
  for (const auto& [name, changes] : lines) text += fmt::format("  {}:  {}\n", name, changes);
  return text;
}

}  // namespace drumlin::apps
