#include "apps/commands/cost/sweep.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "apps/support/json_file.hpp"
#include "coupling/accuracy/work_point.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/text_file.hpp"
#include "coupling/documents/json_numbers.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const char* const point_format = "drumlin-cost-point-1";
const char* const sweep_format = "drumlin-cost-sweep-1";

}  // namespace

GrowingOutput cost_output(const fs::path& folder, ExistingOutput existing, std::vector<fs::path> inputs) {
  return GrowingOutput(
      {folder, existing, "cost", std::move(inputs)},
      {"sweep.json", "cost.json", "cost.json.part", "start.h5", "work_precision.png", "statistics.png",
       "prices.png", "effects.png", "points/*.json", "points/*.h5", "points/*/scene.toml"});
}

PointStore::PointStore(GrowingOutput& output, const Json& shared)
    : output_(output), points_(output.folder() / "points") {
  Json said{{"format", sweep_format}};
  said.update(shared);
  const fs::path file = output.folder() / "sweep.json";
  if (fs::exists(file)) {
    const Json before = read_json(file, sweep_format);
    for (const auto& [key, value] : said.items())
      if (!before.contains(key) || before.at(key) != value)
        throw InputError(
            fmt::format("{}: its points were made with another '{}'; name another folder or give "
                        "--overwrite",
                        output.folder().string(), key));
  }
  make_folders(points_);
  output.forget("*");  // what is written anew beside the points
  output.save();
  write_json(file, said);
}

std::optional<Json> PointStore::finished(const std::string& name) const {
  if (!output_.manifest().files.contains("points/" + name + ".json")) return std::nullopt;
  return read_json(beside(name + ".json"), point_format);
}

void PointStore::keep(const std::string& name, Json point) const {
  Json content{{"format", point_format}, {"name", name}};
  content.update(point);
  write_json(beside(name + ".json"), content);
  output_.list("points/" + name + ".json");
  output_.save();
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
