#pragma once
// From the words of a command line to the options of one command.
#include <string>
#include <variant>
#include <vector>

#include "apps/output/accept.hpp"
#include "apps/output/commands.hpp"

namespace drumlin::apps {

/// Help or version: to be shown, nothing to be done.
struct TextToShow {
  std::string text;
};

using Request = std::variant<TextToShow, RunOptions, MeasureOptions, ImportOptions, CalibrateOptions,
                             FlowOptions, CompareOptions, SceneOptions, SolveContactsOptions, PlotOptions,
                             CostOptions, ExportOptions, StudyOptions, CompareStudyOptions,
                             ScoreOptions, AcceptOptions, HistoryOptions, ReportOptions, NewSceneOptions>;

/// Throws InputError on wrong usage. `solvers` are the names that --solver takes.
Request parse_command_line(int argc, const char* const* argv, const std::vector<std::string>& solvers);

}  // namespace drumlin::apps
