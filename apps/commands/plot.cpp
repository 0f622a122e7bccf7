// drumlin plot: pictures of a run, finished or not.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.hpp"
#include "apps/commands/plot_drawing.hpp"
#include "apps/commands/run_report.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/results.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void check_window(const std::vector<double>& window) {
  if (window.empty()) return;
  const auto finite = [](double edge) { return std::isfinite(edge); };
  if (window.size() != 4 || !std::all_of(window.begin(), window.end(), finite) || !(window[0] < window[1]) ||
      !(window[2] < window[3]))
    throw InputError(
        fmt::format("--window: {} is no part of the plane (allowed: X0,X1,Z0,Z1 in d with X0 < X1 "
                    "and Z0 < Z1)",
                    fmt::join(window, ",")));
}

int plot(const PlotOptions& options) {
  check_window(options.window);
  const fs::path folder = options.output.value_or(options.run / "plots");
  return make_results(results_of(options, "plot", folder, "plots.json"), [&](Results& results) -> Made {
    const particles::RunFolder run = particles::read_run_folder(options.run);
    const Json drawing = drawing_of(run, read_json<RunRecord>(options.run / "run.json"), options);
    const fs::path& made = results.begin();
    if (options.player) {
      print_out(fmt::format("player.html: {} of {} snapshots, about {:.1f} MB\n",
                            drawing["player"]["frames"].size(), run.snapshots.size(),
                            bytes_of_player(drawing["player"]) / 1e6));
      flush_out();
    }
    Json drawn = drawn_run(drawing, made);
    add_accepted_edits(drawn, accepted_edits(run.files));
    write_json(made / "plots.json", drawn);
    std::string said = fmt::format("{}{}\n{}", folder.string(), run.scene.reduced ? " (reduced)" : "",
                                   as_far_as_it_went(run));
    if (run.snapshots.empty()) said += "  the run holds no snapshots: no pictures of grains\n";
    for (const auto& [file, shows] : drawn["figures"].items())
      said += fmt::format("  {:16} {}\n", file, shows.get<std::string>());
    return {said};
  });
}

}  // namespace

Command plot_command() {
  return command("plot", "Draws a run: grains, force chains, accuracy and cost", plot);
}

}  // namespace drumlin::apps
