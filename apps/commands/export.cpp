// drumlin export: a run as files of other programs, in SI (docs/formats/vtu.md, docs/formats/export.md); or
// what was measured of it, small enough to be kept and passed on (docs/formats/measured.md).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.hpp"
#include "apps/commands/run_report.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/results.hpp"
#include "apps/process/progress.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"
#include "coupling/core/results/measured_run.hpp"
#include "particles/io/run_grids.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/io/snapshot_list.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

/// What other programs read: the word for the format, and the file that is then there (exporting/command.py).
const std::map<std::string, std::string>& other_formats() {
  static const std::map<std::string, std::string> formats{
      {"gsd", "run.gsd"}, {"lammps", "grains.dump"}, {"vtkhdf", "run.vtkhdf"}, {"xyz", "run.xyz"}};
  return formats;
}

std::vector<std::string> names_of_formats() {
  std::vector<std::string> names;
  for (const auto& [name, file] : other_formats()) names.push_back(name);
  return names;
}

struct ExportOptions {
  fs::path run;
  std::optional<fs::path> output;
  std::string format;  ///< of another program; empty: none
  bool vtu = false, measurements = false;
  std::string snapshots = "all";
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.add("run", run, "RUN", "Folder of a run, finished or not")
        .required()
        .decides(measurements ? Decides::measured : Decides::content);
    d.add("--vtu", vtu, "VTK files with grains, contacts and walls, for ParaView")
        .excludes("--measurements")
        .decides(Decides::nothing);
    d.add("--to", format, "FORMAT", one_of(names_of_formats()),
          "One file of all snapshots that other programs read; lammps: one of grains, one of contacts")
        .excludes("--vtu")
        .excludes("--measurements");
    d.add(
         "--measurements", measurements,
         "What was measured, without snapshots and figures and with packed maps: what calibrate, compare and "
         "measure --study read in the place of the run")
        .excludes("--vtu")
        .decides(Decides::nothing);
    d.add("--snapshots", snapshots, "LIST",
          "Which snapshots: all, last, or numbers and ranges such as 1,5,10-20")
        .decides(measurements ? Decides::nothing : Decides::value);
    d.output(output, "DIR", "Folder for the files; standard: RUN/vtu, RUN/FORMAT");
    d.existing(existing);
  }
};

/// Fields of the balance of momentum: what checks a measurement, and no law or comparison reads.
bool is_exported(const MapField& field) {
  constexpr std::array left_out{"residual", "inertia", "wall_"};
  return std::none_of(left_out.begin(), left_out.end(),
                      [&](const char* part) { return field.name.find(part) != std::string::npos; });
}

void copy_to(const fs::path& from, const fs::path& to) {
  make_folders(to.parent_path());
  std::error_code failed;
  if (!fs::copy_file(from, to, failed))
    throw IoError(
        fmt::format("{}: cannot be copied from {}: {}", to.string(), from.string(), failed.message()));
}

std::uintmax_t bytes_below(const fs::path& folder) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += entry.file_size();
  return bytes;
}

int export_measurements(const ExportOptions& options) {
  if (!options.output) throw InputError("export --measurements: wants a folder of its own for them: -o DIR");
  return make_results(
      results_of(options, "export", *options.output, "run.json"), [&](Results& results) -> Made {
        const MeasuredRun run = read_measured_run(options.run, Unsteady::accept);
        const fs::path staged = results.begin();
        for (const char* name : {"run.json", "scene.toml"})
          if (fs::exists(options.run / name)) copy_to(checked_file(run.files, name), staged / name);
        for (const char* name : {"measured.json", "profiles.csv", "forces.csv"})
          if (fs::exists(run.measured_files.path / name))
            copy_to(checked_file(run.measured_files, name), staged / "measured" / name);
        if (fs::is_directory(run.measured_files.path / "slices"))
          for (const auto& entry : fs::directory_iterator(run.measured_files.path / "slices")) {
            const std::string name = "slices/" + entry.path().filename().string();
            copy_to(checked_file(run.measured_files, name), staged / "measured" / name);
          }
        if (fs::exists(run.measured_files.path / "maps.h5")) {
          FieldMap map = read_field_map(checked_file(run.measured_files, "maps.h5"));
          std::erase_if(map.fields, [](const MapField& field) { return !is_exported(field); });
          write_field_map(staged / "measured" / "maps.h5", map, MapStorage::packed);
        }
        const double megabytes = static_cast<double>(bytes_below(staged)) * 1e-6;
        std::string said = fmt::format("{}{}: {:.2g} MB\n", options.output->string(),
                                       run.reduced ? " (reduced)" : "", megabytes);
        for (const std::string& reason : run.unsteady)
          said += fmt::format("  warning: {} is not steady: {}\n", run.name, reason);
        return {said};
      });
}

int export_vtu(const ExportOptions& options) {
  const fs::path folder = options.output.value_or(options.run / "vtu");
  return make_results(results_of(options, "export", folder, "grains.pvd"), [&](Results& results) -> Made {
    const particles::RunFolder run = particles::read_run_folder(options.run);
    const std::vector<fs::path> files = particles::chosen_snapshots(run, options.snapshots);
    // What does not fit shows before anything is written.
    (void)particles::shapes_at(run, particles::checked_snapshot(run, files.front()));
    const fs::path& made = results.begin();
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
        make_folders(made / kind);
        replace_file(made / kind / name, particles::vtu_text(grid_of(run, snapshot)));
      }
      steps.emplace_back(snapshot.time * snapshot.scales.time_s, name);
      if (progress.due())
        progress.show(fmt::format("export  {} of {} snapshots", steps.size(), files.size()));
    }
    progress.finish();
    for (const auto& [kind, grid_of] : kinds) {
      auto inside = steps;
      for (auto& [time, name] : inside) name = std::string(kind) + "/" + name;
      replace_file(made / (std::string(kind) + ".pvd"), particles::pvd_text(inside));
    }
    return {fmt::format("{}{}: {} snapshots; open grains.pvd, contacts.pvd and walls.pvd in ParaView\n{}",
                        folder.string(), run.scene.reduced ? " (reduced)" : "", files.size(),
                        as_far_as_it_went(run))};
  });
}

int export_to(const ExportOptions& options) {
  const fs::path folder = options.output.value_or(options.run / options.format);
  const auto request = results_of(options, "export", folder, other_formats().at(options.format));
  return make_results(request, [&](Results& results) -> Made {
    const ResultFolder run = open_result_folder(options.run);
    const auto files = particles::listed_snapshots(options.run, particles::snapshot_files(options.run),
                                                   "--snapshots", options.snapshots);
    std::vector<std::string> words{options.format, results.begin().string()};
    for (const fs::path& file : files)
      words.push_back(checked_file(run, "snapshots/" + file.filename().string()).string());
    Progress progress;
    (void)output_of_script("../exporting/command.py", words, [&](const std::string& line) {
      if (!line.starts_with("{")) return false;
      const auto done = nlohmann::json::parse(line);
      if (progress.due())
        progress.show(fmt::format("export  {} of {} snapshots", done.at("done").dump(), files.size()));
      return true;
    });
    progress.finish();
    return {fmt::format("{}: {} snapshots as {}\n", folder.string(), files.size(), options.format)};
  });
}

int export_run(const ExportOptions& options) {
  if (options.measurements) return export_measurements(options);
  if (!options.format.empty()) return export_to(options);
  if (!options.vtu)
    throw InputError("export: says no format (allowed: --vtu, --to FORMAT or --measurements)");
  return export_vtu(options);
}

}  // namespace

Command export_command() {
  return command("export", "Writes a run in a format of other programs", export_run);
}

}  // namespace drumlin::apps
