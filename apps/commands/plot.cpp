// drumlin plot: pictures of a run, finished or not.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands/plot_drawing.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/commands.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/asked.hpp"
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

}  // namespace

int plot(const PlotOptions& options) {
  check_window(options.window);
  const particles::RunFolder run = particles::read_run_folder(options.run);
  const fs::path folder = options.output.value_or(options.run / "plots");
  const std::string asked = asked_sum({input_sum(options.run), options.snapshot, options.animation,
                                       options.player, options.window, options.color, options.every});
  if (options.existing == ExistingOutput::resume && holds_results(folder, "plots.json"))
    return done_already(folder, asked);
  const Json report = read_json(options.run / "run.json", "drumlin-run-1");
  const Json drawing = drawing_of(run, report, options);
  StagedOutput output({folder, options.existing, "plot", {options.run / "run.json"}, {}, asked});
  if (options.player)
    print_out(fmt::format("player.html: {} of {} snapshots, about {:.1f} MB\n",
                          drawing["player"]["frames"].size(), run.snapshots.size(),
                          bytes_of_player(drawing["player"]) / 1e6));
  flush_out();
  Json drawn = drawn_run(drawing, output.folder());
  add_accepted_edits(drawn, accepted_edits(run.files));
  write_json(output.folder() / "plots.json", drawn);
  output.publish();
  print_out(fmt::format("{}{}\n", folder.string(), run.scene.reduced ? " (reduced)" : ""));
  if (!run.finished())
    print_out(
        fmt::format("  the run is unfinished (status {}): drawn as far as it went\n", name_of(run.status)));
  if (run.snapshots.empty()) print_out("  the run holds no snapshots: no pictures of grains\n");
  for (const auto& [file, shows] : drawn["figures"].items())
    print_out(fmt::format("  {:16} {}\n", file, shows.get<std::string>()));
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
