#include "apps/commands/measure/forces_part.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "apps/output/figures.hpp"
#include "coupling/core/documents/json_numbers.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/layers/variants.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Friction of the scene, where one number holds for all contacts of a kind and bounds the force itself.
std::optional<particles::Friction> one_friction(const fs::path& scene_file) {
  if (!fs::exists(scene_file)) return std::nullopt;
  const particles::Effects effects = particles::read_scene(scene_file).effects;
  if (!effects.friction || !effects.friction->pairs.empty() || effects.cohesion || effects.dynamic_friction)
    return std::nullopt;
  return effects.friction;
}

/// What force_statistics.py is told.
Json request_of(const particles::Measurement& measured, const MeasureOptions& options) {
  const particles::MeasurementFrame& place = measured.place;
  const particles::LayerGrid grid =
      particles::slice_grid(place, options.position, place.slice_width, options.layer_thickness);
  const auto friction = one_friction(options.run() / "scene.toml");
  const auto number = [](double value) { return number_or_null(value); };
  return {
      {"run", options.run().string()},
      {"first", measured.first_snapshot},
      {"batches", place.batches},
      {"interval_factor", place.batches > 1 ? Json(particles::interval_factor(place.batches)) : Json()},
      {"in_mirror", place.in_mirror},
      {"origin", {place.frame.origin_x, place.frame.origin_z}},
      {"x_axis", {place.frame.x_axis_x, place.frame.x_axis_z}},
      {"x", {number(grid.x_min), number(grid.x_max)}},
      {"z_min", grid.z_min},
      {"thickness", grid.thickness},
      {"layers", grid.layers()},
      {"closed", grid.closed},
      {"surface_z", place.container_radius > 0 ? -measured.axis_depth : grid.z_min - measured.wall_z},
      {"wall_z", measured.wall_z},
      {"H", number(measured.fits.H)},
      {"friction",
       {friction ? Json(friction->grain_grain) : Json(), friction ? Json(friction->grain_wall) : Json()}}};
}

}  // namespace

Part forces_part(const MeasureOptions& options) {
  Part part;
  part.name = "forces";
  part.figures = "force_figures.py";
  part.reading.begin = [](const particles::MeasurementFrame&) {};
  part.reading.add = [](const particles::Snapshot&, const particles::FlowSnapshot&, std::size_t) {};
  part.write = [=](const particles::Measurement& measured, const PartOutput& output) {
    for (const char* file : {"forces.csv", "force_distributions.csv", "forces.png"})
      fs::remove(output.folder / file);
    draw_figures("force_statistics.py", {output.folder.string(), request_of(measured, options).dump()});
    const fs::path found = output.folder / "forces.json";
    output.content["forces"] = Json::parse(file_text(found));
    fs::remove(found);
  };
  return part;
}

}  // namespace drumlin::apps
