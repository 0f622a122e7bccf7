// drumlin report: a run on one page, whether a continuum stands beside it or not.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/command_line/command.hpp"
#include "apps/commands/effects_text.hpp"
#include "apps/commands/plot_drawing.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/results.hpp"
#include "apps/process/interruption.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/provenance.hpp"
#include "coupling/core/results/run_records.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ReportOptions {
  fs::path run;
  std::optional<fs::path> output, bundle;
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.add("run", run, "RUN", "Folder of a run, finished or not, measured or not")
        .required()
        .decides(Decides::measured);
    d.output(output, "DIR", "Folder for the page, open its index.html; standard: RUN/report");
    d.add("--bundle", bundle, "FILE.tar.gz",
          "In place of a page: scene, log and versions in one small file, for a report of a fault")
        .decides(Decides::nothing);
    d.existing(existing);
  }
};

Json scene_of(const particles::RunFolder& run) {
  const particles::TimePlan plan = particles::time_plan(run.scene, run.scales);
  Json stages = Json::array();
  for (std::size_t s = 0; s < run.scene.stages.size(); ++s) {
    const particles::Stage& stage = run.scene.stages[s];
    stages.push_back({{"name", stage.name},
                      {"seconds", particles::duration_s(stage)},
                      {"time_step_s", plan.stages[s].time_step * run.scales.time_s},
                      {"snapshots", stage.snapshots},
                      {"may_end_early", stage.until.has_value()}});
  }
  return {{"diameter_mm", run.scales.length_m * 1e3},
          {"effects", effects_text(run.scene.effects)},
          {"periodic", run.scene.periodic_z   ? "in x and z"
                       : run.scene.periodic_x ? "in x"
                                              : ""},
          {"stages", stages},
          {"text", particles::scene_text(run.scene)}};
}

/// RUN/measured as the page shows it: its numbers, its figures copied beside those of the report; else why
/// there is none.
void add_measured(const particles::RunFolder& run, const fs::path& folder, Json& content) {
  const fs::path measured = run.folder / "measured";
  content["measured"] = nullptr;
  content["measured_figures"] = Json::array();
  if (!fs::exists(measured / "measured.json")) {
    content["measured_missing"] = "nothing was measured yet";
    return;
  }
  try {
    const ResultFolder found = open_result_folder(measured);
    check_source(found, run.files, "drumlin measure RUN --overwrite");
    content["measured"] = read_json<MeasuredRecord>(checked_file(found, "measured.json"));
    if (!found.manifest) return;
    for (const auto& [name, entry] : found.manifest->files) {
      if (fs::path(name).extension() != ".png" || fs::path(name).has_parent_path()) continue;
      fs::copy_file(checked_file(found, name), folder / ("measured_" + name));
      content["measured_figures"].push_back(fs::path(name).stem().string());
    }
  } catch (const InputError& error) {
    content["measured"] = nullptr;
    content["measured_missing"] = error.what();
  }
}

Json content_of(const particles::RunFolder& run, const Json& report, const Json& drawn) {
  Json content{{"format", "drumlin-report-1"},
               {"title", run.scene.title.empty() ? run.folder.filename().string() : run.scene.title},
               {"reduced", run.scene.reduced},
               {"run", report},
               {"scene", scene_of(run)},
               {"figures", drawn["figures"]},
               {"provenance", provenance()}};
  add_accepted_edits(content["provenance"], accepted_edits(run.files));
  return content;
}

int report(const ReportOptions& options) {
  if (options.bundle) {
    if (!fs::exists(options.run / "scene.toml"))
      throw InputError(options.run.string() + ": is no folder of a run");
    outlive_readers();
    draw_figures("bundle.py", {options.run.string(), options.bundle->string(), "drumlin " + version_text()});
    print_out(fmt::format("bundle: {}\n", fs::absolute(*options.bundle).string()));
    return static_cast<int>(ExitCode::done);
  }
  const fs::path folder = options.output.value_or(options.run / "report");
  return make_results(results_of(options, "report", folder, "report.json"), [&](Results& results) -> Made {
    const particles::RunFolder run = particles::read_run_folder(options.run);
    const Json record = read_json<RunRecord>(options.run / "run.json");
    PlotOptions pictures;
    pictures.run = options.run;
    pictures.player = !run.snapshots.empty();
    const Json drawing = drawing_of(run, record, pictures);
    const fs::path& made = results.begin();
    if (pictures.player) {
      print_out(fmt::format("player.html: about {:.1f} MB\n", bytes_of_player(drawing["player"]) / 1e6));
      flush_out();
    }
    Json content = content_of(run, record, drawn_run(drawing, made));
    add_measured(run, made, content);
    write_json(made / "report.json", content);
    draw_figures("../pages/write_page.py", {"run.html", (made / "report.json").string(), made.string()});
    std::string said = fmt::format("report: {}{}\n", fs::absolute(folder / "index.html").string(),
                                   run.scene.reduced ? " (reduced)" : "");
    if (content["measured"].is_null())
      said += fmt::format("  without measurements: {}\n", content["measured_missing"].get<std::string>());
    return {said};
  });
}

}  // namespace

Command report_command() { return command("report", "Puts a run on one page, with a player", report); }

}  // namespace drumlin::apps
