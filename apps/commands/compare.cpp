// drumlin compare: two runs of one geometry side by side, particles and continuum as a rule.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/commands/compare_inputs.hpp"
#include "apps/commands/compare_record.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/commands.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/output/pending_figures.hpp"
#include "apps/process/asked.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/comparison/layers.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;

ComparedRuns read_runs(const CompareOptions& options) {
  const Unsteady unsteady = options.accept_unsteady ? Unsteady::accept : Unsteady::refuse;
  ComparedRuns runs{load_side(options.run, unsteady), load_side(options.flow_run, unsteady), {}, {}};
  const auto require_same = [&](const LoadedSide& second) {
    coupling::require_same_geometry(runs.first.compared.profiles, second.compared.profiles);
    require_same_scales(runs.first, second);
  };
  require_same(runs.second);
  const auto load_another = [&](const std::optional<fs::path>& folder, std::optional<LoadedSide>& side) {
    if (folder) require_same(side.emplace(load_side(*folder, unsteady)));
  };
  load_another(options.floor, runs.floor);
  load_another(options.beside, runs.beside);
  return runs;
}

}  // namespace

int compare(const CompareOptions& options) {
  const fs::path finished = options.output / "comparison.json";
  const auto sum_of = [](const std::optional<fs::path>& folder) {
    return folder ? measured_run_sum(*folder) : "";
  };
  const std::string asked =
      asked_sum({measured_run_sum(options.run), measured_run_sum(options.flow_run), sum_of(options.floor),
                 sum_of(options.beside), options.registration, options.accept_unsteady});
  if (options.existing == ExistingOutput::resume && is_complete(finished))
    return done_already(options.output, asked);
  const ComparedRuns runs = read_runs(options);
  const bool drums = coupling::geometry_of(runs.first.compared.profiles) == Geometry::drum;
  if (options.beside && !drums)
    throw InputError({InputProblem{.file = "",
                                   .key = "--beside",
                                   .what = "a flow in layers has no targets",
                                   .allowed = "absent, or runs of a drum"}});
  const ComparisonReport report = drums ? drum_report(runs, options) : layer_report(runs, options);

  std::vector<fs::path> read{options.run, options.flow_run};
  for (const auto& another : {options.floor, options.beside})
    if (another) read.push_back(*another);
  StagedOutput output({options.output, options.existing, "compare", read, {}, asked});
  const fs::path& folder = output.folder();
  report.write_overlays(folder);
  note_pending_figures(folder);
  const fs::path file = folder / "comparison.json";
  write_json(file, *report.content);
  const auto failures =
      draw_pending_figures(folder, report.figures(folder, file), ResultPage{report.page, file});
  output.publish();
  print_out(
      fmt::format("{}report: {}\n", report.summary, fs::absolute(options.output / "index.html").string()));
  throw_if_figures_failed(finished, failures);
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
