#pragma once
// The options of each command, described to a parser; parsing fills in the struct.
#include <string>
#include <vector>

#include "apps/output/accept.hpp"
#include "apps/output/commands.hpp"

namespace CLI {
class App;
}

namespace drumlin::apps {

void add_run_options(CLI::App& command, RunOptions& options);
/// Either one run is measured, or measured ones are studied together.
void add_measure_options(CLI::App& command, MeasureOptions& options, StudyOptions& study);
void add_import_options(CLI::App& command, ImportOptions& options);
void add_plot_options(CLI::App& command, PlotOptions& options);
void add_report_options(CLI::App& command, ReportOptions& options);
void add_new_scene_options(CLI::App& command, NewSceneOptions& options);
void add_export_options(CLI::App& command, ExportOptions& options);
void add_history_options(CLI::App& command, HistoryOptions& options);
void add_solve_contacts_options(CLI::App& command, SolveContactsOptions& options,
                                const std::vector<std::string>& solvers);
void add_calibrate_options(CLI::App& command, CalibrateOptions& options);
void add_flow_options(CLI::App& command, FlowOptions& options);
/// Either a pair is compared, or all speeds of both sides are.
void add_compare_options(CLI::App& command, CompareOptions& options, CompareStudyOptions& study);
void add_score_options(CLI::App& command, ScoreOptions& options);
void add_accept_options(CLI::App& command, AcceptOptions& options);
void add_cost_options(CLI::App& command, CostOptions& options);

}  // namespace drumlin::apps
