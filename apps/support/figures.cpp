#include "apps/support/figures.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "apps/support/interruption.hpp"
#include "apps/support/program_files.hpp"
#include "coupling/common/child_process.hpp"
#include "coupling/common/errors.hpp"

namespace drumlin::apps {

void draw_figures(const std::string& script, const std::vector<std::string>& arguments) {
  ProcessRequest request;
  request.program = interpreter();
  const std::filesystem::path figures = figures_folder();
  // Nothing is imported from the current folder, from PYTHONPATH or from the user's own packages.
  request.words = {"-I", "-B", (figures / "isolated.py").string(), (figures / script).string()};
  request.words.insert(request.words.end(), arguments.begin(), arguments.end());
  // Agg draws without a display; threads in OpenBLAS cost more than they bring to a figure.
  request.environment = {"MPLBACKEND=Agg", "OPENBLAS_NUM_THREADS=1", "OMP_NUM_THREADS=1"};
  // Standard output stays free for the command's own results (--json).
  request.output = ProcessOutput::with_errors;
  std::string said;
  request.line = [&](const std::string& line) { said += line + "\n"; };
  request.pass_signals_on = true;
  const CaughtInterruptions caught;  // the script ends by them, and we with it
  const ProcessEnd end = run_process(request);
  stop_if_interrupted();
  if (!end.succeeded())
    throw IoError(fmt::format("{} failed:\n{}", std::filesystem::path(script).filename().string(), said));
}

}  // namespace drumlin::apps
