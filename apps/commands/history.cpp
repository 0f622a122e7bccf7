// drumlin history: mean stress, fabric and strain of a region, the forces on walls and the angle of the
// surface, snapshot by snapshot
// (docs/formats/history.md).
#include <fmt/format.h>

#include <numbers>

#include "apps/command_line/command.hpp"
#include "apps/commands/run_report.hpp"
#include "apps/output/results.hpp"
#include "apps/process/progress.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/provenance.hpp"
#include "coupling/core/documents/csv.hpp"
#include "coupling/core/files/result_folder.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/results/run_header.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/io/snapshot_list.hpp"
#include "particles/measurement/history/region_history.hpp"
#include "particles/measurement/history/surface_history.hpp"
#include "particles/measurement/history/wall_history.hpp"
#include "particles/scene/scene_walls.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using particles::Rectangle;

struct HistoryOptions {
  fs::path run;
  std::optional<fs::path> output;
  std::vector<double> box;  ///< x_min, x_max, z_min, z_max in d, laboratory axes; empty: walls alone
  int sectors = 36;         ///< of a circular container
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.add("run", run, "RUN", "Folder of a run, finished or not").required();
    d.add("--box", box, "X_MIN,X_MAX,Z_MIN,Z_MAX",
          "Region whose mean stress, fabric and strain are written, in d, in the axes of the scene; absent: "
          "the walls alone");
    d.add("--sectors", sectors, "", at_least(1, 10000),
          "Sectors of a circular container in which its tractions are averaged");
    d.output(output, "DIR", "Folder for the tables; standard: RUN/history");
    d.existing(existing);
  }
};

constexpr double degrees = 180 / std::numbers::pi;

std::vector<std::string> numbers(std::initializer_list<double> values) {
  std::vector<std::string> fields;
  for (const double value : values) fields.push_back(csv_number(value));
  return fields;
}

std::string line_of(std::vector<std::string> first, const std::vector<std::string>& rest) {
  first.insert(first.end(), rest.begin(), rest.end());
  return csv_line(first);
}

/// Where the first shape of a wall stands, and how far it has turned.
struct WallPlace {
  particles::Point at;
  double angle = 0;
};

/// What was asked for, as the heads of the tables say it.
std::string settings_text(const HistoryOptions& options) {
  return fmt::format("# box = {}\n# sectors = {}\n",
                     options.box.empty() ? "none" : fmt::format("{}", fmt::join(options.box, " ")),
                     options.sectors);
}

/// The tables, line by line.
class Tables {
 public:
  Tables(const particles::RunFolder& run, const HistoryOptions& options)
      : options_(options), walls_(particles::walls_of(run.scene, run.scales)) {
    RunHeader header;
    header.side = RunSide::particles;
    header.title = run.scene.title;
    header.reduced = run.scene.reduced;
    header.revision = provenance().revision;
    header.diameter_m = run.scales.length_m;
    const std::string lines = header_lines(header, "# ") + settings_text(options);
    walls =
        "# drumlin-history-walls-1\n" + lines + "snapshot,time,wall,x,z,angle_deg,force_x,force_z,torque\n";
    tractions =
        "# drumlin-history-tractions-1\n" + lines + "snapshot,time,wall,from_deg,to_deg,normal,shear\n";
    surface = "# drumlin-history-surface-1\n" + lines +
              "snapshot,time,angle_deg,mass_angle_deg,left_deg,right_deg,repose_deg\n";
    if (options.box.empty()) return;
    history_.emplace(Rectangle{options.box[0], options.box[1], options.box[2], options.box[3]});
    region =
        "# drumlin-history-region-1\n" + lines +
        "snapshot,time,grains,nu,coordination,sigma_xx,sigma_zz,sigma_xz,sigma_zx,sigma_xx_kinetic,"
        "sigma_zz_kinetic,sigma_xz_kinetic,fabric_xx,fabric_zz,fabric_xz,d_v_x_dx,d_v_x_dz,d_v_z_dx,d_v_z_dz,"
        "strain\n";
  }

  void add(const particles::RunFolder& run, const fs::path& file) {
    const particles::Snapshot snapshot = particles::checked_snapshot(run, file);
    const std::vector<std::string> stamp{std::to_string(particles::snapshot_number(file)),
                                         csv_number(snapshot.time)};
    add_walls(run, snapshot, stamp);
    const particles::SurfaceState u = particles::surface_state(snapshot);
    surface += line_of(stamp, numbers({u.angle * degrees, u.mass_angle * degrees, u.left * degrees,
                                       u.right * degrees, u.repose * degrees}));
    if (!history_) return;
    const particles::RegionState& s = history_->add(snapshot);
    region += line_of(stamp, numbers({static_cast<double>(s.grains), s.nu, s.coordination, s.pressure.xx,
                                      s.pressure.zz, -s.pressure.xz, -s.pressure.zx, s.kinetic.xx,
                                      s.kinetic.zz, -s.kinetic.xz, s.fabric.xx, s.fabric.zz, s.fabric.xz,
                                      s.gradient.xx, s.gradient.xz, s.gradient.zx, s.gradient.zz, s.strain}));
  }

  std::string walls, tractions, surface, region;

 private:
  void add_walls(const particles::RunFolder& run, const particles::Snapshot& snapshot,
                 const std::vector<std::string>& stamp) {
    std::vector<particles::Shape> shapes;
    std::vector<WallPlace> places(walls_.names.size());
    std::vector<bool> placed(walls_.names.size(), false), standing(walls_.names.size(), true);
    for (const particles::PlacedShape& shape : particles::shapes_at(run, snapshot)) {
      const auto wall = static_cast<std::size_t>(walls_.wall_of_shape[shapes.size()]);
      if (!placed[wall]) places[wall] = {middle_of(shape.shape), shape.angle};
      placed[wall] = true;
      standing[wall] = !is_open(shape.shape);
      shapes.push_back(shape.shape);
    }
    const auto states = particles::wall_states(snapshot, walls_.names.size(), walls_.wall_of_shape, shapes,
                                               static_cast<std::size_t>(options_.sectors));
    for (std::size_t w = 0; w < states.size(); ++w) {
      auto first = stamp;
      first.push_back(walls_.names[w]);
      const WallPlace& place = places[w];
      if (!standing[w]) continue;
      walls += line_of(first, numbers({place.at.x, place.at.z, place.angle * degrees, states[w].force_x,
                                       states[w].force_z, states[w].torque}));
      for (const particles::WallSector& s : states[w].sectors)
        tractions += line_of(first, numbers({s.from * degrees, s.to * degrees, s.normal, s.shear}));
    }
  }

  const HistoryOptions& options_;
  particles::Walls walls_;
  std::optional<particles::RegionHistory> history_;
};

void check_box(const std::vector<double>& box) {
  if (box.empty()) return;
  if (box.size() != 4 || !(box[0] < box[1]) || !(box[2] < box[3]))
    throw InputError(
        "--box: X_MIN,X_MAX,Z_MIN,Z_MAX in d, each less than its partner, in the axes of the scene");
}

int history(const HistoryOptions& options) {
  check_box(options.box);
  const fs::path folder = options.output.value_or(options.run / "history");
  ResultsRequest requested = results_of(options, "history", folder, "walls.csv");
  requested.computed_from = options.run;
  return make_results(requested, [&](Results& results) -> Made {
    const particles::RunFolder run = particles::read_run_folder(options.run);
    if (run.snapshots.empty()) throw InputError(run.folder.string() + ": holds no snapshots");
    const fs::path& made = results.begin();
    Tables tables(run, options);
    Progress progress;
    std::size_t done = 0;
    for (const fs::path& file : run.snapshots) {
      tables.add(run, file);
      ++done;
      if (progress.due())
        progress.show(fmt::format("history  {} of {} snapshots", done, run.snapshots.size()));
    }
    progress.finish();
    if (!options.box.empty()) replace_file(made / "region.csv", tables.region);
    replace_file(made / "surface.csv", tables.surface);
    replace_file(made / "tractions.csv", tables.tractions);
    replace_file(made / "walls.csv", tables.walls);
    return {fmt::format("{}{}: {} snapshots\n{}", folder.string(), run.scene.reduced ? " (reduced)" : "",
                        done, as_far_as_it_went(run))};
  });
}

}  // namespace

Command history_command() {
  return command("history",
                 "Stress and strain of a region, forces on walls, angle of the surface, snapshot by snapshot",
                 history);
}

}  // namespace drumlin::apps
