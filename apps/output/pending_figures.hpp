#pragma once
// Figures and the page that show the results of a command, made once these are complete: what fails is named
// and loses nothing.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::apps {

/// A script of apps/figures and the words that it is called with.
struct FigureScript {
  std::string script;
  std::vector<std::string> arguments;
};

/// FOLDER/index.html: the template apps/pages/NAME.html, filled with a JSON file and the figures of the
/// folder.
struct ResultPage {
  std::string name;
  std::filesystem::path content;
};

/// Notes in FOLDER/figures.pending that figures are still to be drawn. Written before the file that says that
/// the results are complete, so that a command which ends early is known to have left no figures.
void note_pending_figures(const std::filesystem::path& folder);

/// Whether `finished` (measured.json, ...) is there with all results beside it and no figure of its folder is
/// still to be drawn. Throws InputError as holds_results().
bool is_complete(const std::filesystem::path& finished);

/// Runs every script, whatever became of those before it, and then writes the page, which tells the failures
/// so far; returns what the failed ones said, each with its name. Removes figures.pending where none failed,
/// else the failures stand in it.
std::vector<std::string> draw_pending_figures(const std::filesystem::path& folder,
                                              const std::vector<FigureScript>& figures,
                                              const std::optional<ResultPage>& page = std::nullopt);

/// Throws IoError with these failures and that the results in `finished` are complete; nothing without any.
void throw_if_figures_failed(const std::filesystem::path& finished, const std::vector<std::string>& failures);

}  // namespace drumlin::apps
