#include "apps/commands/cost/sweep.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>

#include "apps/support/interruption.hpp"
#include "apps/support/json_file.hpp"
#include "coupling/accuracy/pareto.hpp"
#include "coupling/exchange/errors.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const char* const point_format = "drumlin-cost-point-1";
const char* const sweep_format = "drumlin-cost-sweep-1";

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

double number_of(const std::string& name, const std::string& text) {
  double number = NAN;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !(number > 0) || !std::isfinite(number))
    throw InputError({InputProblem{.file = {},
                                   .key = "--sweep " + name,
                                   .what = fmt::format("'{}' is no value", text),
                                   .allowed = "number > 0"}});
  return number;
}

}  // namespace

std::vector<SweepAxis> sweep_axes(const std::vector<std::string>& words,
                                  const std::vector<std::string>& allowed) {
  std::vector<SweepAxis> axes;
  for (const std::string& word : words) {
    const auto parts = split(word, '=');
    if (parts.size() > 2 || std::find(allowed.begin(), allowed.end(), parts[0]) == allowed.end())
      throw InputError(
          {InputProblem{.file = {},
                        .key = "--sweep",
                        .what = fmt::format("'{}' is nothing that this scene can be swept over", parts[0]),
                        .allowed = fmt::format("{}", fmt::join(allowed, ", "))}});
    if (find_axis(axes, parts[0]) != nullptr)
      throw InputError(fmt::format("--sweep: {} is named twice", parts[0]));
    axes.push_back({parts[0], parts.size() == 2 ? split(parts[1], ':') : std::vector<std::string>{}});
  }
  if (axes.empty())
    for (const std::string& name : allowed) axes.push_back({name, {}});
  return axes;
}

const SweepAxis* find_axis(const std::vector<SweepAxis>& axes, const std::string& name) {
  for (const SweepAxis& axis : axes)
    if (axis.name == name) return &axis;
  return nullptr;
}

std::vector<double> numbers_of(const SweepAxis& axis, const std::vector<double>& standard) {
  if (axis.values.empty()) return standard;
  std::vector<double> numbers;
  for (const std::string& value : axis.values) numbers.push_back(number_of(axis.name, value));
  return numbers;
}

PointStore::PointStore(fs::path output, const Json& shared) : points_(output / "points") {
  Json said{{"format", sweep_format}};
  said.update(shared);
  const fs::path file = output / "sweep.json";
  if (fs::exists(file)) {
    const Json before = read_json(file, sweep_format);
    for (const auto& [key, value] : said.items())
      if (!before.contains(key) || before.at(key) != value)
        throw InputError(
            fmt::format("{}: its points were made with another '{}'; name another folder or give "
                        "--overwrite",
                        output.string(), key));
  }
  fs::create_directories(points_);
  write_json(file, said);
}

std::optional<Json> PointStore::finished(const std::string& name) const {
  const fs::path file = beside(name + ".json");
  if (!fs::exists(file)) return std::nullopt;
  return read_json(file, point_format);
}

void PointStore::keep(const std::string& name, Json point) const {
  Json content{{"format", point_format}, {"name", name}};
  content.update(point);
  write_json(beside(name + ".json"), content);
}

fs::path PointStore::beside(const std::string& name) const { return points_ / name; }

double process_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double load_average() {
  double load[1] = {NAN};
  return getloadavg(load, 1) == 1 ? load[0] : NAN;
}

void mark_fronts(Json& points, const std::vector<std::string>& quantities) {
  for (Json& point : points) point["pareto"] = Json::array();
  for (const std::string& quantity : quantities) {
    std::vector<double> seconds, errors;
    for (const Json& point : points) {
      const auto error = point.at("errors").find(quantity);
      const bool known = error != point.at("errors").end() && error->is_number();
      seconds.push_back(point.at("cpu_seconds").is_number() ? point.at("cpu_seconds").get<double>() : NAN);
      errors.push_back(known ? error->get<double>() : NAN);
    }
    const std::vector<bool> front = pareto_front(seconds, errors);
    for (std::size_t i = 0; i < front.size(); ++i)
      if (front[i]) points[i]["pareto"].push_back(quantity);
  }
}

void stop_if_interrupted() {
  if (const int signal = interruption())
    throw Interrupted{static_cast<int>(signal == SIGTERM ? ExitCode::terminated : ExitCode::interrupted)};
}

}  // namespace drumlin::apps
