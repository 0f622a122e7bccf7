#include "apps/commands/measure/forces_part.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/support/json_file.hpp"
#include "coupling/common/scratch_file.hpp"
#include "coupling/common/text_file.hpp"
#include "coupling/documents/csv.hpp"
#include "coupling/documents/json_numbers.hpp"
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
  particles::LayerGrid grid;
  std::vector<particles::ContactForces> batches;
};

/// Friction of the scene, where one number holds for all contacts of a kind and bounds the force itself.
std::optional<particles::Friction> one_friction(const fs::path& scene_file) {
  if (!fs::exists(scene_file)) return std::nullopt;
  const particles::Effects effects = particles::read_scene(scene_file).effects;
  if (!effects.friction || !effects.friction->pairs.empty() || effects.cohesion || effects.dynamic_friction)
    return std::nullopt;
  return effects.friction;
}

/// force_distributions.csv: one line per zone, quantity and bin.
void write_distributions(const fs::path& file, const std::vector<particles::ForceZone>& zones) {
  std::string text = "# drumlin-force-distributions-1\nzone,quantity,from,to,value,ci99,contacts\n";
  for (const particles::ForceZone& zone : zones)
    for (const particles::DistributionRow& row : zone.rows)
      text +=
          csv_line({zone.name, row.quantity, csv_number(row.from, 6), csv_number(row.to, 6),
                    csv_number(row.value, 6), csv_number(row.ci99, 6), fmt::format("{:.0f}", row.contacts)});
  replace_file(file, text);
}

Json content_of(const particles::ForceStatistics& found, const particles::ForceSettings& settings) {
  Json zones;
  for (const particles::ForceZone& zone : found.zones) {
    Json& entry = zones[zone.name];
    entry["z"] = {zone.z_from, zone.z_to};
    add_scalars(entry, zone.scalars);
  }
  const auto number = [](const std::optional<double>& value) { return number_or_null(value); };
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
  part.reading.begin = [=](const particles::MeasurementFrame& place) {
    reading->grid =
        particles::slice_grid(place, options.position, place.slice_width, options.layer_thickness);
    const auto file = std::make_shared<ScratchFile>(options.run);
    for (std::size_t b = 0; b < place.batches; ++b) reading->batches.emplace_back(file);
  };
  part.reading.add = [=](const particles::Snapshot& snapshot, const particles::FlowSnapshot&,
                         std::size_t batch) {
    particles::add_contact_forces(reading->grid, snapshot, reading->batches[batch]);
  };
  part.write = [=](const particles::Measurement& measured, const PartOutput& output) {
    particles::ForceSettings settings;
    settings.surface_z =
        measured.place.container_radius > 0 ? -measured.axis_depth : reading->grid.z_min - measured.wall_z;
    settings.wall_z = measured.wall_z;
    settings.H = measured.fits.H;
    if (const auto friction = one_friction(options.run / "scene.toml")) {
      settings.friction_grains = friction->grain_grain;
      settings.friction_walls = friction->grain_wall;
    }
    particles::ForceStatistics found = particles::force_statistics(reading->grid, reading->batches, settings);
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
