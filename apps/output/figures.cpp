#include "apps/output/figures.hpp"

#include <fmt/format.h>

#include <csignal>
#include <filesystem>

#include "apps/process/interruption.hpp"
#include "apps/process/program_files.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/machine/child_process.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;

ProcessRequest request_for(const std::string& script, const std::vector<std::string>& arguments) {
  ProcessRequest request;
  request.program = interpreter();
  const fs::path figures = figures_folder();
  // Nothing is imported from the current folder, from PYTHONPATH or from the user's own packages.
  request.words = {"-I", "-B", (figures / "isolated.py").string(),
                   (figures / script).lexically_normal().string()};
  request.words.insert(request.words.end(), arguments.begin(), arguments.end());
  // Agg draws without a display; threads in OpenBLAS cost more than they bring to a figure.
  request.environment = {"MPLBACKEND=Agg", "OPENBLAS_NUM_THREADS=1", "OMP_NUM_THREADS=1"};
  request.output = ProcessOutput::with_errors;
  return request;
}

/// Runs it to its end, which signals hasten.
ProcessEnd end_of(ProcessRequest request) {
  request.caught = interruption;
  const CaughtInterruptions caught;  // the script ends by them, and we with it
  const ProcessEnd end = run_process(request);
  stop_if_interrupted();
  return end;
}

}  // namespace

std::string output_of_script(const std::string& script, const std::vector<std::string>& arguments,
                             const std::function<bool(const std::string&)>& take) {
  ProcessRequest request = request_for(script, arguments);
  std::string said;
  // Standard output stays free for the command's own results (--json).
  request.line = [&](const std::string& line) {
    if (!take || !take(line)) said += line + "\n";
  };
  const ProcessEnd end = end_of(request);
  if (end.shell_code() == static_cast<int>(ExitCode::wrong_input))
    throw InputError(said.substr(0, said.find_last_not_of('\n') + 1));
  if (!end.succeeded())
    throw IoError(fmt::format("{} failed:\n{}", fs::path(script).filename().string(), said));
  return said;
}

void draw_figures(const std::string& script, const std::vector<std::string>& arguments) {
  (void)output_of_script(script, arguments);
}

int end_of_command(const std::string& script, const std::vector<std::string>& arguments) {
  ProcessRequest request = request_for(script, arguments);
  request.environment = {};  // what it measures runs as it would alone
  request.output = ProcessOutput::standard;
  request.line = [](const std::string& line) {
    print_out(line + "\n");
    flush_out();
  };
  request.end_signal = SIGTERM;  // it ends what it has started
  return end_of(request).shell_code();
}

}  // namespace drumlin::apps
