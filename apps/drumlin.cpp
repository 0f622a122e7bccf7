// The drumlin command: words to options, options to a command.
#include "apps/command_line/command_line.hpp"
#include "apps/output/commands.hpp"
#include "apps/output/program.hpp"
#include "apps/process/interruption.hpp"
#include "apps/process/standard_streams.hpp"
#include "particles/lab/any_solver.hpp"

namespace {

using namespace drumlin;

struct Execute {
  int operator()(const apps::TextToShow& shown) const {
    apps::print_out(shown.text);
    return 0;
  }
  int operator()(const apps::RunOptions& options) const {
    return options.ranks ? apps::run_by_mpirun(options) : apps::run(options);
  }
  int operator()(const apps::MeasureOptions& options) const { return apps::measure(options); }
  int operator()(const apps::StudyOptions& options) const { return apps::study(options); }
  int operator()(const apps::ImportOptions& options) const { return apps::import_foreign(options); }
  int operator()(const apps::PlotOptions& options) const { return apps::plot(options); }
  int operator()(const apps::ReportOptions& options) const { return apps::report(options); }
  int operator()(const apps::NewSceneOptions& options) const { return apps::new_scene(options); }
  int operator()(const apps::ExportOptions& options) const { return apps::export_run(options); }
  int operator()(const apps::HistoryOptions& options) const { return apps::history(options); }
  int operator()(const apps::CalibrateOptions& options) const { return apps::calibrate(options); }
  int operator()(const apps::FlowOptions& options) const { return apps::flow(options); }
  int operator()(const apps::CompareOptions& options) const { return apps::compare(options); }
  int operator()(const apps::CompareStudyOptions& options) const { return apps::compare_study(options); }
  int operator()(const apps::ScoreOptions& options) const { return apps::score(options); }
  int operator()(const apps::SceneOptions& options) const { return apps::scene(options); }
  int operator()(const apps::AcceptOptions& options) const { return apps::accept(options); }
  int operator()(const apps::CostOptions& options) const { return apps::cost(options); }
  int operator()(const apps::SolveContactsOptions& options) const { return apps::solve_contacts(options); }
};

/// Whether the results of a command are files: it then finishes them although nobody reads what it prints.
struct LeavesFiles {
  bool operator()(const apps::TextToShow&) const { return false; }
  bool operator()(const apps::SceneOptions&) const { return false; }
  bool operator()(const apps::ImportOptions& options) const { return !options.keys; }
  bool operator()(const apps::CostOptions& options) const { return options.output.has_value(); }
  bool operator()(const apps::SolveContactsOptions& options) const { return options.output.has_value(); }
  template <class Other>
  bool operator()(const Other&) const {
    return true;
  }
};

int done_as_asked(int argc, char** argv) {
  const apps::Request request = apps::parse_command_line(argc, argv, particles::any_solver_names());
  if (std::visit(LeavesFiles{}, request)) apps::outlive_readers();
  return std::visit(Execute{}, request);
}

}  // namespace

int main(int argc, char** argv) {
  return drumlin::apps::run_program([&] { return done_as_asked(argc, argv); });
}
