// drumlin import: a run folder of the snapshots of another program.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "apps/json/json_file.hpp"
#include "apps/output/commands.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/asked.hpp"
#include "apps/process/progress.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/run_status.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/import/import_run.hpp"
#include "particles/io/snapshot_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json report_of(const particles::ImportDescription& description, const fs::path& file,
               const particles::ImportReport& report) {
  return {{"format", "drumlin-run-1"},
          {"title", description.title},
          {"reduced", description.reduced},
          {"status", name_of(RunStatus::finished)},
          {"imported", true},
          {"imported_from",
           {{"description", file.filename().string()},
            {"kind", std::holds_alternative<particles::LammpsSource>(description.source) ? "lammps" : "csv"},
            {"files", report.files},
            {"unused_columns", report.unused_columns},
            {"left_out", report.left_out},
            {"with_spin", report.with_spin},
            {"with_contacts", report.with_contacts}}},
          {"grains", report.grains},
          {"snapshots", report.snapshots},
          {"simulated_seconds", report.last_time_s},
          {"scales", to_json(report.scales)},
          {"provenance", to_json(provenance())}};
}

void print_summary(const fs::path& run, const particles::ImportDescription& description,
                   const particles::ImportReport& report) {
  print_out(fmt::format("{}{}: {} snapshots of {} grains, {:.6g} s to {:.6g} s\n", run.string(),
                        description.reduced ? " (reduced)" : "", report.snapshots, report.grains,
                        report.first_time_s, report.last_time_s));
  print_out(fmt::format("  d = {:.6g} mm, sqrt(d/g) = {:.6g} s; velocities are those {}\n",
                        report.scales.length_m * 1e3, report.scales.time_s,
                        description.grains.velocities == particles::ImportedVelocities::given
                            ? "at the instant of the snapshot"
                            : "since the snapshot before"));
  if (report.with_contacts)
    print_out(fmt::format("  {} contacts that carry a force\n", report.contacts));
  else
    print_out("  without contacts: no stress will be measured\n");
  if (!report.with_spin) print_out("  without spin\n");
  if (report.unused_period_m)
    print_out(
        fmt::format("  the dump is periodic over {:g} m along x, the description is not: grains and contacts "
                    "do not reach across its border (periodic_x)\n",
                    *report.unused_period_m));
  for (const std::string& snapshot : report.left_out) print_out(fmt::format("  left out: {}\n", snapshot));
  if (!report.unused_columns.empty())
    print_out(fmt::format("  columns that were not used: {}\n", fmt::join(report.unused_columns, ", ")));
}

}  // namespace

int import_foreign(const ImportOptions& options) {
  if (options.keys) {
    print_out(options.markdown ? keys_as_markdown(particles::import_keys())
                               : keys_as_text(particles::import_keys()));
    return static_cast<int>(ExitCode::done);
  }
  if (!options.description || !options.output)
    throw InputError("import: needs a description and an output: drumlin import DESCRIPTION.toml -o RUN");
  const fs::path run = *options.output;
  const particles::ImportDescription description =
      particles::read_import_description(*options.description, options.overrides);
  const fs::path folder = fs::absolute(*options.description).parent_path();
  Json inputs = Json::array({particles::import_description_text(description)});
  for (const fs::path& file : particles::import_files(description, folder)) {
    inputs.push_back(fs::relative(file, folder).string());
    inputs.push_back(input_sum(file));
  }
  const std::string asked = asked_sum(inputs);
  if (options.existing == ExistingOutput::resume && holds_results(run, "run.json"))
    return done_already(run, asked);
  StagedOutput output({run, options.existing, "import", {folder}, {}, asked});
  make_folders(output.folder() / "snapshots");
  replace_file(output.folder() / "import.toml", particles::import_description_text(description));

  Progress progress;
  std::size_t done = 0;
  const particles::ImportReport report =
      particles::import_run(description, folder, [&](const particles::Snapshot& snapshot) {
        particles::write_snapshot(output.folder() / "snapshots" / fmt::format("{:06}.h5", snapshot.step),
                                  snapshot);
        if (++done; progress.due()) progress.show(fmt::format("import  {} snapshots", done));
      });
  progress.finish();
  write_json(output.folder() / "run.json", report_of(description, *options.description, report));
  output.publish();
  print_summary(run, description, report);
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
