// The drumlin command: words to options, options to a command, errors to an exit code.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "apps/command_line/command_line.hpp"
#include "apps/support/commands.hpp"
#include "coupling/common/errors.hpp"
#include "particles/solver/contact_solver.hpp"

namespace {

using namespace drumlin;

struct Execute {
  int operator()(const apps::TextToShow& shown) const {
    fmt::print("{}", shown.text);
    return 0;
  }
  int operator()(const apps::RunOptions& options) const { return apps::run(options); }
  int operator()(const apps::MeasureOptions& options) const { return apps::measure(options); }
  int operator()(const apps::StudyOptions& options) const { return apps::study(options); }
  int operator()(const apps::ImportOptions& options) const { return apps::import_foreign(options); }
  int operator()(const apps::PlotOptions& options) const { return apps::plot(options); }
  int operator()(const apps::ExportOptions& options) const { return apps::export_run(options); }
  int operator()(const apps::CalibrateOptions& options) const { return apps::calibrate(options); }
  int operator()(const apps::FlowOptions& options) const { return apps::flow(options); }
  int operator()(const apps::CompareOptions& options) const { return apps::compare(options); }
  int operator()(const apps::CompareStudyOptions& options) const { return apps::compare_study(options); }
  int operator()(const apps::SceneOptions& options) const { return apps::scene(options); }
  int operator()(const apps::AcceptOptions& options) const { return apps::accept(options); }
  int operator()(const apps::CostOptions& options) const { return apps::cost(options); }
  int operator()(const apps::SolveContactsOptions& options) const { return apps::solve_contacts(options); }
  int operator()(const apps::HardcasesOptions& options) const { return apps::hardcases(options); }
};

int failed(ExitCode code, const std::string& message) {
  std::fflush(stdout);
  fmt::print(stderr, "{}\n", message);
  return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return std::visit(Execute{}, apps::parse_command_line(argc, argv, particles::contact_solver_names()));
  } catch (const InputError& error) {
    return failed(ExitCode::wrong_input, error.what());  // one line per problem
  } catch (const NotConvergedError& error) {
    return failed(ExitCode::not_converged, error.what());
  } catch (const IoError& error) {
    return failed(ExitCode::input_output, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return failed(ExitCode::input_output, error.what());
  }
  // Anything else is a fault of ours: it ends the program with its message and a core, not with a code that
  // means something.
}
