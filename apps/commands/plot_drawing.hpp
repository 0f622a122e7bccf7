#pragma once
// What the script of `drumlin plot` is asked to draw of a run.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "apps/commands/plot_options.hpp"
#include "particles/io/run_folder.hpp"

namespace drumlin::apps {

/// Everything that the script needs; `report` is run.json. Throws InputError where a run cannot be drawn as
/// the options want it, and for damaged snapshots.
nlohmann::ordered_json drawing_of(const particles::RunFolder& run, const nlohmann::ordered_json& report,
                                  const PlotOptions& options);

/// About how large the player of a drawing becomes: what is told before it is written.
double bytes_of_player(const nlohmann::ordered_json& player);

/// Draws into a folder and returns which figures there are, with what each shows (plots.json).
nlohmann::ordered_json drawn_run(const nlohmann::ordered_json& drawing, const std::filesystem::path& folder);

}  // namespace drumlin::apps
