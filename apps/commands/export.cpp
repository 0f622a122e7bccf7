// drumlin export: a run as files that ParaView reads, in SI (docs/formats/vtu.md).
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/output/commands.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/asked.hpp"
#include "apps/process/progress.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/io/run_grids.hpp"
#include "particles/io/snapshot_file.hpp"

namespace drumlin::apps {

namespace fs = std::filesystem;

int export_run(const ExportOptions& options) {
  if (options.measurements) return export_measurements(options);
  if (!options.vtu) throw InputError("export: says no format (allowed: --vtu or --measurements)");
  const particles::RunFolder run = particles::read_run_folder(options.run);
  const fs::path folder = options.output.value_or(options.run / "vtu");
  const std::string asked = asked_sum({input_sum(options.run), options.snapshots});
  if (options.existing == ExistingOutput::resume && holds_results(folder, "grains.pvd"))
    return done_already(folder, asked);
  const std::vector<fs::path> files = particles::chosen_snapshots(run, options.snapshots);
  // What does not fit shows before anything is written.
  (void)particles::shapes_at(run, particles::checked_snapshot(run, files.front()));
  StagedOutput output({folder, options.existing, "export", {options.run / "run.json"}, {}, asked});

  const std::pair<const char*,
                  particles::VtuGrid (*)(const particles::RunFolder&, const particles::Snapshot&)>
      kinds[] = {{"contacts", particles::contact_grid},
                 {"walls", particles::wall_grid},
                 {"grains", particles::grain_grid}};
  std::vector<std::pair<double, std::string>> steps;
  Progress progress;
  for (const fs::path& file : files) {
    const particles::Snapshot snapshot = particles::checked_snapshot(run, file);
    const std::string name = file.stem().string() + ".vtu";
    for (const auto& [kind, grid_of] : kinds) {
      make_folders(output.folder() / kind);
      replace_file(output.folder() / kind / name, particles::vtu_text(grid_of(run, snapshot)));
    }
    steps.emplace_back(snapshot.time * snapshot.scales.time_s, name);
    if (progress.due()) progress.show(fmt::format("export  {} of {} snapshots", steps.size(), files.size()));
  }
  progress.finish();
  for (const auto& [kind, grid_of] : kinds) {
    auto inside = steps;
    for (auto& [time, name] : inside) name = std::string(kind) + "/" + name;
    replace_file(output.folder() / (std::string(kind) + ".pvd"), particles::pvd_text(inside));
  }
  output.publish();
  print_out(fmt::format("{}{}: {} snapshots; open grains.pvd, contacts.pvd and walls.pvd in ParaView\n",
                        folder.string(), run.scene.reduced ? " (reduced)" : "", files.size()));
  if (!run.finished())
    print_out(fmt::format("  the run is unfinished (status {}): as far as it went\n", name_of(run.status)));
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
