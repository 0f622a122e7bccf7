// drumlin export --measurements: what was measured of a run, small enough to be kept and passed on
// (docs/formats/measured.md).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "apps/output/commands.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/asked.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"
#include "coupling/core/results/measured_run.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

/// Fields of the balance of momentum: what checks a measurement, and no law or comparison reads.
bool is_kept(const MapField& field) {
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

}  // namespace

int export_measurements(const ExportOptions& options) {
  if (!options.output) throw InputError("export --measurements: wants a folder of its own for them: -o DIR");
  const fs::path& folder = *options.output;
  const std::string asked = asked_sum({measured_run_sum(options.run)});
  if (options.existing == ExistingOutput::resume && holds_results(folder, "run.json"))
    return done_already(folder, asked);
  const MeasuredRun run = read_measured_run(options.run, Unsteady::accept);
  StagedOutput output({folder, options.existing, "export", {options.run / "run.json"}, {}, asked});
  const fs::path staged = output.folder();
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
    std::erase_if(map.fields, [](const MapField& field) { return !is_kept(field); });
    write_field_map(staged / "measured" / "maps.h5", map, MapStorage::packed);
  }
  const double megabytes = static_cast<double>(bytes_below(staged)) * 1e-6;
  output.publish();
  print_out(fmt::format("{}{}: {:.2g} MB\n", folder.string(), run.reduced ? " (reduced)" : "", megabytes));
  for (const std::string& reason : run.unsteady)
    print_out(fmt::format("  warning: {} is not steady: {}\n", run.name, reason));
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
