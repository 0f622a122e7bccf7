// drumlin import: a run folder of the snapshots of another program.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "apps/command_line/command.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/results.hpp"
#include "apps/process/progress.hpp"
#include "apps/process/request_sum.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/run_status.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/results/run_records.hpp"
#include "particles/import/description.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ImportOptions {
  std::optional<fs::path> description, output;
  std::vector<std::string> overrides;
  bool keys = false, markdown = false;
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.add("description", description, "DESCRIPTION.toml", "What the files are (docs/formats/import.md)")
        .decides(Decides::nothing);
    d.output(output, "RUN", "Folder for the snapshots");
    d.changes(overrides);
    d.add("--keys", keys, "Lists every key of a description with unit, range, default and meaning")
        .decides(Decides::nothing);
    d.add("--markdown", markdown, "With --keys: as a table in Markdown").decides(Decides::nothing);
    d.existing(existing);
  }
};

std::vector<std::string> texts_of(const std::vector<fs::path>& files) { return {files.begin(), files.end()}; }

/// `report`: of importing/command.py.
RunRecord record_of(const particles::ImportDescription& description, const fs::path& file, const Json& files,
                    const Json& report) {
  Json from{{"description", file.filename().string()}, {"kind", report.at("kind")}, {"files", files}};
  for (const char* key : {"unused_columns", "left_out", "with_spin", "with_contacts"})
    from[key] = report.at(key);
  RunRecord record;
  record.title.json = description.title;
  record.reduced = description.reduced;
  record.status = name_of(RunStatus::finished);
  record.imported = true;
  record.imported_from.json = from;
  record.grains = report.at("grains").get<std::int64_t>();
  record.snapshots = report.at("snapshots").get<std::int64_t>();
  record.simulated_seconds = report.at("last_time_s").get<double>();
  record.scales.json = report.at("scales");
  record.provenance.json = provenance();
  return record;
}

std::string summary_of(const fs::path& run, const particles::ImportDescription& description,
                       const Json& report) {
  const auto number = [&](const char* key) { return report.at(key).get<double>(); };
  const auto texts = [&](const char* key) { return report.at(key).get<std::vector<std::string>>(); };
  std::string text = fmt::format("{}{}: {:.0f} snapshots of {:.0f} grains, {:.6g} s to {:.6g} s\n",
                                 run.string(), description.reduced ? " (reduced)" : "", number("snapshots"),
                                 number("grains"), number("first_time_s"), number("last_time_s"));
  const Json& scales = report.at("scales");
  text += fmt::format("  d = {:.6g} mm, sqrt(d/g) = {:.6g} s; velocities are those {}\n",
                      scales.at("length_m").get<double>() * 1e3, scales.at("time_s").get<double>(),
                      description.grains.velocities == particles::ImportedVelocities::given
                          ? "at the instant of the snapshot"
                          : "since the snapshot before");
  text += report.at("with_contacts")
              ? fmt::format("  {:.0f} contacts that carry a force\n", number("contacts"))
              : "  without contacts: no stress will be measured\n";
  if (!report.at("with_spin")) text += "  without spin\n";
  if (!report.at("unused_period_m").is_null())
    text += fmt::format(
        "  the dump is periodic over {:g} m along x, the description is not: grains and contacts "
        "do not reach across its border (periodic_x)\n",
        number("unused_period_m"));
  for (const std::string& snapshot : texts("left_out")) text += fmt::format("  left out: {}\n", snapshot);
  if (!report.at("unused_columns").empty())
    text += fmt::format("  columns that were not used: {}\n", fmt::join(texts("unused_columns"), ", "));
  return text;
}

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
  const auto [grains, contacts] = std::visit(
      [&](const auto& source) {
        return std::pair(particles::files_of(folder, source.grains),
                         particles::files_of(folder, source.contacts));
      },
      description.source);
  Json inputs = Json::array({particles::import_description_text(description)}), names = Json::array();
  for (const auto& files : {grains, contacts}) {
    for (const fs::path& file : files) {
      inputs.push_back(names.emplace_back(fs::relative(file, folder).string()));
      inputs.push_back(input_sum(file));
    }
  }
  ResultsRequest request = results_of(options, "import", run, "run.json", inputs);
  request.inputs = {folder};
  return make_results(request, [&](Results& results) -> Made {
    const fs::path& made = results.begin();
    make_folders(made / "snapshots");
    replace_file(made / "import.toml", particles::import_description_text(description));
    replace_file(made / "files.json",
                 Json{{"grains", texts_of(grains)}, {"contacts", texts_of(contacts)}}.dump());
    Progress progress;
    Json report;
    (void)output_of_script("../importing/command.py", {made.string()}, [&](const std::string& line) {
      if (!line.starts_with("{")) return false;
      report = Json::parse(line);
      if (progress.due()) progress.show(fmt::format("import  {} snapshots", report.at("snapshots").dump()));
      return true;
    });
    fs::remove(made / "files.json");
    progress.finish();
    write_json(made / "run.json", record_of(description, *options.description, names, report));
    return {summary_of(run, description, report)};
  });
}

}  // namespace

Command import_command() {
  return command("import",
                 "Makes a run folder of another program's snapshots (LAMMPS, MercuryDPM, Yade, GSD, VTK, "
                 "XYZ, H5MD, CSV)",
                 import_foreign);
}

}  // namespace drumlin::apps
