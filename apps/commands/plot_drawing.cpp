#include "apps/commands/plot_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/json/drawn_walls.hpp"
#include "apps/json/json_file.hpp"
#include "apps/json/records.hpp"
#include "apps/output/figures.hpp"
#include "coupling/core/basics/errors.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/io/snapshot_list.hpp"
#include "particles/scene/materials.hpp"
#include "particles/scene/placement.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t most_frames = 150;  // of an animation: a picture each, and a file that opens anywhere
constexpr std::size_t most_played = 200;  // of a player: 7183 grains stay below 11 MB
// Bytes of a player for each grain and each contact of a frame, as found on drums, chutes and silos.
constexpr double bytes_per_grain = 4.6, bytes_per_contact = 1.7;

/// What the script needs to draw one snapshot. Reading it here refuses damaged files before anything is
/// drawn.
Json frame_of(const particles::RunFolder& run, const fs::path& file) {
  const particles::Snapshot snapshot = particles::checked_snapshot(run, file);
  return {{"file", file.string()},
          {"number", particles::snapshot_number(file)},
          {"time_s", snapshot.time * run.scales.time_s},
          {"grains", snapshot.x.size()},
          {"contacts", snapshot.contacts.size()},
          {"walls", drawn_walls(particles::shapes_at(run, snapshot))}};
}

/// Every `every`-th snapshot, the last among them; 0: as many as `most` leaves.
Json frames_of(const particles::RunFolder& run, std::size_t every, std::size_t most) {
  const std::size_t all = run.snapshots.size();
  const std::size_t stride = every > 0 ? every : (all + most - 1) / most;
  Json frames = Json::array();
  for (std::size_t i = (all - 1) % stride; i < all; i += stride)
    frames.push_back(frame_of(run, run.snapshots[i]));
  return frames;
}

/// Material of each grain, as the scene places them; empty names without any.
struct GrainMaterials {
  std::vector<std::string> names;
  std::vector<std::uint8_t> of_grain;
};

GrainMaterials materials_of(const particles::RunFolder& run) {
  const std::vector<std::string> names = particles::material_names(run.scene);
  // Before the outlets: a scene that has none gains nothing by losing them.
  if (names.empty() || !particles::materials_matter(run.scene))
    throw InputError(
        fmt::format("{}: --color material: the grains of this scene have no materials, "
                    "or no law tells them apart",
                    run.folder.string()));
  if (particles::changes_grains(run.scene))
    throw InputError(run.folder.string() +
                     ": --color material: grains of this scene come and go, and snapshots hold no materials");
  GrainMaterials found{names, particles::place_grains(run.scene, run.scales).material};
  found.names.push_back("none");
  return found;
}

void add_materials(const GrainMaterials& materials, Json& frame, const particles::RunFolder& run) {
  const particles::Snapshot snapshot = particles::read_snapshot(frame["file"].get<std::string>());
  if (snapshot.x.size() != materials.of_grain.size())
    throw InputError(fmt::format("{}: --color material: a snapshot holds {} grains, the scene places {}",
                                 run.folder.string(), snapshot.x.size(), materials.of_grain.size()));
  frame["materials"] = materials.of_grain;
}

/// Frames of the player, and materials where the scene has any and no grain comes or goes.
Json player_of(const particles::RunFolder& run, std::size_t every) {
  Json player{{"frames", frames_of(run, every, most_played)},
              {"material_names", Json::array()},
              {"materials", Json::array()}};
  const bool same_grains =
      std::all_of(player["frames"].begin(), player["frames"].end(),
                  [&](const Json& frame) { return frame["grains"] == player["frames"].front()["grains"]; });
  if (!same_grains || particles::changes_grains(run.scene) || !particles::materials_matter(run.scene))
    return player;
  const GrainMaterials materials = materials_of(run);
  if (materials.of_grain.size() != player["frames"].front()["grains"]) return player;
  player["material_names"] = materials.names;
  player["materials"] = materials.of_grain;
  return player;
}

Json stages_of(const particles::Scene& scene) {
  Json stages = Json::array();
  double end = 0;
  for (const particles::Stage& stage : scene.stages)
    stages.push_back({{"name", stage.name}, {"end_s", end += particles::duration_s(stage)}});
  return stages;
}

}  // namespace

Json drawing_of(const particles::RunFolder& run, const Json& report, const PlotOptions& options) {
  Json drawing{{"title", run.scene.title.empty() ? run.folder.filename().string() : run.scene.title},
               {"reduced", run.scene.reduced},
               {"status", name_of(run.status)},
               {"run", report},
               {"log", checked_file(run.files, "log.csv").string()},
               {"energy", nullptr},
               {"tolerance", run.scene.solver.tolerance},
               {"penetration_tolerance", run.scene.solver.penetration_tolerance},
               {"stages", stages_of(run.scene)},
               {"period", drawn_period(run.scene, run.scales)},
               {"snapshot", nullptr},
               {"color", options.color.empty() ? Json(nullptr) : Json(options.color)},
               {"window", options.window.empty() ? Json(nullptr) : Json(options.window)},
               {"animation", options.animation},
               {"player", nullptr},
               {"materials", Json::array()},
               {"frames", Json::array()}};
  if (fs::exists(run.folder / "energy.csv"))
    drawing["energy"] = checked_file(run.files, "energy.csv").string();
  const bool named = options.snapshot != "last";
  if (named || !run.snapshots.empty())
    drawing["snapshot"] = frame_of(run, particles::chosen_snapshot(run, options.snapshot));
  if (options.animation && run.snapshots.size() < 2)
    throw InputError(fmt::format("{}: an animation needs two snapshots, there are {}", run.folder.string(),
                                 run.snapshots.size()));
  if (options.player && run.snapshots.empty())
    throw InputError(run.folder.string() + ": a player needs a snapshot, there is none");
  const auto every = static_cast<std::size_t>(options.every.value_or(0));
  if (options.animation || (every > 0 && !options.player && !run.snapshots.empty()))
    drawing["frames"] = frames_of(run, every, most_frames);
  if (options.player) drawing["player"] = player_of(run, every);
  if (options.color == "material" && !drawing["snapshot"].is_null()) {
    const GrainMaterials materials = materials_of(run);
    drawing["materials"] = materials.names;
    add_materials(materials, drawing["snapshot"], run);
    for (Json& frame : drawing["frames"]) add_materials(materials, frame, run);
  }
  if (options.color == "spin" && !run.scene.effects.spin)
    throw InputError(run.folder.string() + ": --color spin: the grains of this scene have no spin");
  return drawing;
}

double bytes_of_player(const Json& player) {
  double bytes = 5e4;  // of the page itself
  for (const Json& frame : player["frames"])
    bytes +=
        bytes_per_grain * frame["grains"].get<double>() + bytes_per_contact * frame["contacts"].get<double>();
  return bytes;
}

Json drawn_run(const Json& drawing, const fs::path& folder) {
  // The script reads what to draw and writes what it drew.
  const fs::path request = folder / "asked.json", found = folder / "drawn.json";
  write_json(request, drawing);
  draw_figures("plot_figures.py", {request.string()});
  Json drawn = read_json<PlotsRecord>(found);
  fs::remove(found);
  fs::remove(request);
  return drawn;
}

}  // namespace drumlin::apps
