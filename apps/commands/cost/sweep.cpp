#include "apps/commands/cost/sweep.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/support/json_file.hpp"
#include "coupling/accuracy/work_point.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/documents/json_numbers.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const char* const point_format = "drumlin-cost-point-1";
const char* const sweep_format = "drumlin-cost-sweep-1";

}  // namespace

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

Json json_of(const coupling::NamedNumbers& numbers) {
  Json object = Json::object();
  for (const auto& [name, value] : numbers) object[name] = number_or_null(value);
  return object;
}

void mark_fronts(Json& points, const std::vector<std::string>& quantities) {
  std::vector<coupling::WorkPoint> work;
  for (const Json& point : points) {
    coupling::WorkPoint one{number_or_nan(point.at("cpu_seconds")).value(), {}};
    for (const auto& [name, error] : point.at("errors").items())
      one.errors.emplace_back(name, number_or_nan(error).value());
    work.push_back(std::move(one));
  }
  const auto stands_on = coupling::fronts(work, quantities);
  for (std::size_t i = 0; i < work.size(); ++i) points[i]["pareto"] = Json(stands_on[i]);
}

}  // namespace drumlin::apps
