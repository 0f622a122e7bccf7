// drumlin compare: two runs of one geometry side by side, particles and continuum as a rule.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/commands/compare_inputs.hpp"
#include "apps/commands/compare_record.hpp"
#include "apps/commands/study.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/pending_figures.hpp"
#include "apps/output/results.hpp"
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
  const bool is_pair = !options.run.empty() && !options.flow_run.empty();
  if (options.study.empty() ? !is_pair : !options.run.empty())
    throw InputError("compare: either RUN and FLOWRUN, or --study DIR... is required");
  if (!options.study.empty())
    return compare_study(results_of(options, "compare --study", options.output, "study.json"), options.study,
                         options.limits);
  return make_results(
      results_of(options, "compare", options.output, "comparison.json"), [&](Results& results) -> Made {
        const ComparedRuns runs = read_runs(options);
        const bool drums = coupling::geometry_of(runs.first.compared.profiles) == Geometry::drum;
        if (options.beside && !drums)
          throw InputError({InputProblem{.file = "",
                                         .key = "--beside",
                                         .what = "a flow in layers has no targets",
                                         .allowed = "absent, or runs of a drum"}});
        const ComparisonReport report = drums ? drum_report(runs, options) : layer_report(runs, options);
        const fs::path &folder = results.begin(), file = folder / "comparison.json";
        report.write_overlays(folder);
        note_pending_figures(folder);
        write_json(file, *report.content);
        return {fmt::format("{}report: {}\n", report.summary,
                            fs::absolute(options.output / "index.html").string()),
                draw_pending_figures(folder, report.figures(folder, file), ResultPage{report.page, file})};
      });
}

Command compare_command() {
  return command("compare", "Sets a run and a continuum flow side by side", compare);
}

}  // namespace drumlin::apps
