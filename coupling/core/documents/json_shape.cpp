#include "coupling/core/documents/json_shape.hpp"

#include <fmt/format.h>

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "coupling/core/basics/enum_names.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/one_line.hpp"

namespace drumlin {
namespace {

using Json = nlohmann::ordered_json;

enum class Kind { text, line, number, number_or_null, truth, table, table_or_null, list };
constexpr auto names_of(Kind) {
  return std::array{"a text",  "a text of one line", "a number", "a number or null", "true or false",
                    "a table", "a table or null",    "an array"};
}
enum class Presence { optional, required };  ///< within a table that is there

/// The values at a path; "*" stands for each entry of a table or list.
struct Rule {
  std::string_view path;
  Kind kind;
  Presence presence = Presence::optional;
};

constexpr Rule of_runs[] = {{"title", Kind::line},
                            {"reduced", Kind::truth},
                            {"status", Kind::text},
                            {"imported", Kind::truth},
                            {"wall_seconds", Kind::number},
                            {"cpu_seconds", Kind::number},
                            {"peak_memory_mb", Kind::number},
                            {"steps", Kind::number},
                            {"steps_planned", Kind::number},
                            {"unconverged_steps", Kind::number},
                            {"revision", Kind::text},
                            {"seed", Kind::number},
                            {"threads", Kind::number},
                            {"grains", Kind::number},
                            {"simulated_seconds", Kind::number},
                            {"snapshots", Kind::number},
                            {"accuracy", Kind::table},
                            {"cost", Kind::table},
                            {"cost.*", Kind::number_or_null},
                            {"energy", Kind::table},
                            {"energy.*", Kind::number_or_null},
                            {"scales", Kind::table},
                            {"scales.*", Kind::number},
                            {"provenance", Kind::table}};

constexpr Rule of_measurements[] = {{"reduced", Kind::truth},
                                    {"steadiness", Kind::table},
                                    {"steadiness.steady", Kind::truth},
                                    {"steadiness.reasons", Kind::list},
                                    {"steadiness.reasons.*", Kind::text},
                                    {"settings", Kind::table},
                                    {"settings.scales", Kind::table},
                                    {"settings.scales.*", Kind::number_or_null},
                                    {"fits", Kind::table},
                                    {"provenance", Kind::table},
                                    {"seconds", Kind::number}};

constexpr Rule of_flows[] = {{"geometry", Kind::text},
                             {"reduced", Kind::truth},
                             {"seconds", Kind::number},
                             {"cpu_seconds", Kind::number},
                             {"iterations", Kind::number},
                             {"unknowns", Kind::number},
                             {"settings", Kind::table},
                             {"settings.title", Kind::line},
                             {"settings.rotation", Kind::number_or_null},
                             {"settings.law", Kind::table},
                             {"settings.law.law", Kind::text},
                             {"settings.law.nu", Kind::number},
                             {"settings.law.fitted_on", Kind::list},
                             {"settings.law.fitted_on.*", Kind::text},
                             {"settings.scales", Kind::table},
                             {"settings.scales.*", Kind::number_or_null},
                             {"meshes", Kind::list},
                             {"meshes.*", Kind::table},
                             {"meshes.*.unknowns", Kind::number, Presence::required},
                             {"closed_form", Kind::table_or_null},
                             {"closed_form.scalars", Kind::table, Presence::required},
                             {"law_band", Kind::table_or_null},
                             {"law_band.scalars", Kind::table},
                             {"phases", Kind::table_or_null},
                             {"phases.*", Kind::table},
                             {"missed", Kind::list},
                             {"missed.*", Kind::text}};

constexpr Rule of_records[] = {{"kind", Kind::text},
                               {"scene", Kind::text},
                               {"points", Kind::list, Presence::required},
                               {"points.*", Kind::table},
                               {"points.*.name", Kind::text},
                               {"points.*.statistics", Kind::table},
                               {"points.*.statistics.scalars", Kind::table, Presence::required}};

constexpr Rule of_convergence[] = {{"scene", Kind::text},
                                   {"settings", Kind::table, Presence::required},
                                   {"settings.*", Kind::table},
                                   {"settings.*.another_scene", Kind::truth}};

constexpr Rule of_points[] = {{"name", Kind::text, Presence::required},
                              {"failure", Kind::text},
                              {"cpu_seconds", Kind::number_or_null},
                              {"seconds", Kind::number_or_null},
                              {"iterations", Kind::number},
                              {"peak_memory_mb", Kind::number},
                              {"marks", Kind::list},
                              {"marks.*", Kind::table},
                              {"marks.*.simulated_seconds", Kind::number, Presence::required},
                              {"marks.*.errors", Kind::table},
                              {"marks.*.errors.*", Kind::number_or_null},
                              {"settings", Kind::table},
                              {"scalars", Kind::table},
                              {"statistics", Kind::table},
                              {"profile", Kind::table},
                              {"profile.v_x", Kind::list, Presence::required},
                              {"profile.v_x.*", Kind::number_or_null},
                              {"phases", Kind::table_or_null},
                              {"phases.*", Kind::table}};

constexpr Rule of_plots[] = {{"figures", Kind::table, Presence::required}, {"figures.*", Kind::text}};

std::span<const Rule> rules_of(const std::string& format) {
  static const std::map<std::string, std::span<const Rule>> all = {{"drumlin-run-1", of_runs},
                                                                   {"drumlin-measured-1", of_measurements},
                                                                   {"drumlin-flow-run-2", of_flows},
                                                                   {"drumlin-cost-1", of_records},
                                                                   {"drumlin-convergence-1", of_convergence},
                                                                   {"drumlin-cost-point-1", of_points},
                                                                   {"drumlin-plots-1", of_plots}};
  const auto found = all.find(format);
  return found == all.end() ? std::span<const Rule>() : found->second;
}

bool is_of(const Json& value, Kind kind) {
  switch (kind) {
    case Kind::text:
      return value.is_string();
    case Kind::line:
      return value.is_string() &&
             fault_of_line(value.get_ref<const std::string&>(), std::numeric_limits<std::size_t>::max())
                 .empty();
    case Kind::number:
      return value.is_number();
    case Kind::number_or_null:
      return value.is_number() || value.is_null();
    case Kind::truth:
      return value.is_boolean();
    case Kind::table:
      return value.is_object();
    case Kind::table_or_null:
      return value.is_object() || value.is_null();
    case Kind::list:
      return value.is_array();
  }
  return false;
}

std::string shortened(std::string text) {
  constexpr std::size_t enough = 60;
  if (text.size() > enough) text = text.substr(0, enough) + "...";
  return text;
}

/// Walks down the rest of a rule's path; what has another type on the way is another rule's.
class Check {
 public:
  Check(const std::filesystem::path& file, std::vector<InputProblem>& problems)
      : file_(file.string()), problems_(problems) {}

  void below(const Json& value, std::string_view rest, const std::string& key, const Rule& rule) {
    const auto dot = rest.find('.');
    const std::string step(rest.substr(0, dot));
    const std::string_view further = dot == std::string_view::npos ? "" : rest.substr(dot + 1);
    if (step == "*") {
      if (value.is_structured())
        for (const auto& [name, entry] : value.items()) at(entry, further, joined(key, name), rule);
    } else if (value.is_object()) {
      if (const auto found = value.find(step); found != value.end())
        at(*found, further, joined(key, step), rule);
      else if (further.empty() && rule.presence == Presence::required)
        problems_.push_back({file_, 0, 0, joined(key, step), "is missing", name_of(rule.kind)});
    }
  }

 private:
  static std::string joined(const std::string& key, const std::string& step) {
    return key.empty() ? step : key + "." + step;
  }

  void at(const Json& value, std::string_view rest, const std::string& key, const Rule& rule) {
    if (!rest.empty()) return below(value, rest, key, rule);
    if (!is_of(value, rule.kind))
      problems_.push_back({file_, 0, 0, shortened(key), "is " + shortened(value.dump()), name_of(rule.kind)});
  }

  std::string file_;
  std::vector<InputProblem>& problems_;
};

}  // namespace

std::vector<InputProblem> type_problems(const std::filesystem::path& file, const Json& content,
                                        const std::string& format) {
  std::vector<InputProblem> problems;
  Check check(file, problems);
  for (const Rule& rule : rules_of(format)) check.below(content, rule.path, "", rule);
  return problems;
}

}  // namespace drumlin
