#include "apps/commands/measure/forces_part.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/support/json_file.hpp"
#include "coupling/exchange/text_file.hpp"
#include "particles/measurement/forces/contact_forces.hpp"
#include "particles/measurement/forces/force_statistics.hpp"
#include "particles/measurement/layers/variants.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The contacts read so far.
struct Reading {
  LayerGrid grid;
  std::vector<ContactForces> batches;
};

/// Friction of the scene, where one number holds for all contacts of a kind and bounds the force itself.
std::optional<Friction> one_friction(const fs::path& scene_file) {
  if (!fs::exists(scene_file)) return std::nullopt;
  const Effects effects = read_scene(scene_file).effects;
  if (!effects.friction || !effects.friction->pairs.empty() || effects.cohesion) return std::nullopt;
  return effects.friction;
}

std::string number_text(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

/// force_distributions.csv: one line per zone, quantity and bin.
void write_distributions(const fs::path& file, const std::vector<ForceZone>& zones) {
  std::string text = "# drumlin-force-distributions-1\nzone,quantity,from,to,value,ci99,contacts\n";
  for (const ForceZone& zone : zones)
    for (const DistributionRow& row : zone.rows)
      text += fmt::format("{},{},{:.6g},{:.6g},{},{},{:.0f}\n", zone.name, row.quantity, row.from, row.to,
                          number_text(row.value), number_text(row.ci99), row.contacts);
  replace_file(file, text);
}

Json content_of(const ForceStatistics& found, const ForceSettings& settings) {
  Json zones;
  for (const ForceZone& zone : found.zones) {
    Json& entry = zones[zone.name];
    entry["z"] = {zone.z_from, zone.z_to};
    add_scalars(entry, zone.scalars);
  }
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  return {{"zones", zones},
          {"settings",
           {{"normalised_by", "mean normal force at the depth of the contact, over the whole run"},
            {"surface_margin", settings.surface_margin},
            {"interface_gap", settings.interface_gap},
            {"wall_margin", settings.wall_margin},
            {"friction_grain_grain", number(settings.friction_grains)},
            {"friction_grain_wall", number(settings.friction_walls)}}}};
}

}  // namespace

Part forces_part(const MeasureOptions& options) {
  const auto reading = std::make_shared<Reading>();
  Part part;
  part.name = "forces";
  part.figures = "force_figures.py";
  part.reading.begin = [=](const MeasurementFrame& place) {
    reading->grid = slice_grid(place, options.position, place.slice_width, options.layer_thickness);
    reading->batches.resize(place.batches);
  };
  part.reading.add = [=](const Snapshot& snapshot, const FlowSnapshot&, std::size_t batch) {
    add_contact_forces(reading->grid, snapshot, reading->batches[batch]);
  };
  part.write = [=](const Measurement& measured, const PartOutput& output) {
    ForceSettings settings;
    settings.surface_z =
        measured.place.container_radius > 0 ? -measured.axis_depth : reading->grid.z_min - measured.wall_z;
    settings.wall_z = measured.wall_z;
    settings.H = measured.fits.H;
    if (const auto friction = one_friction(options.run / "scene.toml")) {
      settings.friction_grains = friction->grain_grain;
      settings.friction_walls = friction->grain_wall;
    }
    ForceStatistics found = force_statistics(reading->grid, reading->batches, settings);
    if (found.layers.z.empty()) {  // no contact carries a force, or the snapshots know none
      output.content["forces"] = nullptr;
      for (const char* file : {"forces.csv", "force_distributions.csv", "forces.png"})
        fs::remove(output.folder / file);
      return;
    }
    found.layers.header = measured.profiles.header;
    write_profiles(output.folder / "forces.csv", found.layers);
    write_distributions(output.folder / "force_distributions.csv", found.zones);
    output.content["forces"] = content_of(found, settings);
  };
  return part;
}

}  // namespace drumlin::apps
