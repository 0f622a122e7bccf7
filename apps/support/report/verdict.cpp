#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/support/html.hpp"
#include "apps/support/report/sections.hpp"
#include "apps/support/report/words.hpp"

namespace drumlin::apps::report {

namespace {

/// How many times its limit a target's value is; NaN when not measured.
double over_limit(const Json& target) { return value_of(target["value"]) / target["limit"].get<double>(); }

std::string asked(const Json& target) {
  return fmt::format("{} where {} ({}) is asked", shown(target["value"]), shown(target["limit"]),
                     escaped(target["measure"].get<std::string>()));
}

/// "the particles", or "particles 6rpm-seed2" of two runs of one kind.
std::string the_side(const Json& comparison, const std::string& side) {
  const std::string name = side_name(comparison, side);
  return name.find(' ') == std::string::npos ? "the " + name : name;
}

std::string what_was_compared(const Json& comparison) {
  const Json registration = comparison.value("registration", Json::object());
  const std::string first = the_side(comparison, "particles"), second = the_side(comparison, "continuum");
  std::string text = fmt::format("<p>Compared: <b>{}</b> with <b>{}</b>", first, second);
  if (first == "the particles" && second == "the continuum")
    text +=
        ". The continuum knows of the particles the friction law, the volume fraction, the fill and the "
        "speed of rotation, nothing else";
  const double offset = value_of(registration.value("offset", Json()));
  if (registration.value("by", "") == "axis" && std::isfinite(offset) && std::abs(offset) > 0)
    text += fmt::format(
        ". Both are looked at in the same places of the drum, counted from its axis: the line "
        "from which {} counts its depth lies {:.2f} d {} that of {}",
        second, std::abs(offset), offset > 0 ? "above" : "below", first);
  return text + ".</p>\n";
}

std::string largest_miss(const Json& comparison) {
  const Json* largest = nullptr;
  for (const Json& target : comparison["targets"])
    if (target["outcome"] == "missed" &&
        (largest == nullptr || !(over_limit(target) <= over_limit(*largest))))
      largest = &target;
  if (largest == nullptr) return {};
  std::string text = fmt::format("<p>The largest miss: {}, {}", target_name(*largest), asked(*largest));
  if (const double times = over_limit(*largest); std::isfinite(times))
    text += fmt::format(", {:.1f} times the limit", times);
  const std::string meaning = meaning_of_a_miss((*largest)["quantity"].get<std::string>());
  return text + (meaning.empty() ? "" : ". It means that " + meaning) + ".</p>\n";
}

std::string all_misses(const Json& comparison) {
  std::string rows;
  for (const Json& target : comparison["targets"]) {
    if (target["outcome"] != "missed") continue;
    const std::string remark = target.value("remark", std::string());
    rows += fmt::format("<li>{}: {}{}</li>", target_name(target), asked(target),
                        remark.empty() ? "" : "; " + escaped(remark));
  }
  return rows.empty() ? std::string() : "<p>Missed:</p><ul>" + rows + "</ul>\n";
}

/// What another run of the same particles would have missed.
std::string floor_sentence(const Json& comparison) {
  const Json floor = comparison.value("floor", Json());
  if (!floor.is_object()) return {};
  std::string missed;
  for (const Json& target : comparison["targets"]) {
    if (!(value_of(target.value("floor", Json())) > target["limit"].get<double>())) continue;
    missed +=
        fmt::format("{}{} ({})", missed.empty() ? "" : ", ", target_name(target), shown(target["floor"]));
  }
  return fmt::format(
      "<p>The noise floor: another run of the particles ({}), judged in the same way, {}.</p>\n",
      escaped(floor.value("name", std::string())),
      missed.empty() ? std::string("meets every target")
                     : "misses " + missed + ": that much is noise of the particles themselves");
}

std::string cost_sentence(const Json& comparison) {
  const Json ratio = comparison.value("cost_ratio", Json::object());
  const Json& costs = comparison["costs"];
  std::vector<std::string> parts;
  for (const auto& [name, seconds] : costs.items())
    if (is_known(seconds)) parts.push_back(fmt::format("{} {:.4g} s", escaped(name), seconds.get<double>()));
  if (parts.empty()) return {};
  std::string text = "<p>Costs: ";
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i == 0 ? "" : "; ") + parts[i];
  const Json wall = ratio.value("wall", Json()), processor = ratio.value("processor", Json());
  if (is_known(processor))
    text += fmt::format(". The first side took {} times the processor time of the second", shown(processor));
  else if (is_known(wall))
    text += fmt::format(". The first side took {} times as long as the second", shown(wall));
  return text + ".</p>\n";
}

std::string unsteady_sentences(const Json& comparison) {
  std::string text;
  for (const char* side : {"particles", "continuum"})
    for (const Json& reason : comparison[side].value("unsteady", Json::array()))
      text += fmt::format("<p class=\"reduced\">{} is not steady: {}</p>\n", side_name(comparison, side),
                          escaped(reason.get<std::string>()));
  return text;
}

}  // namespace

std::string verdict(const Json& comparison) {
  const Json& counts = comparison["verdict"];
  const int met = counts["met"], missed = counts["missed"], absent = counts["not_measured"];
  std::string text = unsteady_sentences(comparison);
  text += fmt::format("<div class=\"verdict {}\"><p><b>The {} meets {} of {} targets</b>",
                      missed == 0 && met > 0 ? "good" : "bad", side_name(comparison, "continuum"), met,
                      met + missed);
  text += absent > 0 ? fmt::format("; {} could not be measured.</p>\n", absent) : ".</p>\n";
  return text + what_was_compared(comparison) + largest_miss(comparison) + all_misses(comparison) +
         floor_sentence(comparison) + cost_sentence(comparison) + "</div>\n";
}

}  // namespace drumlin::apps::report
