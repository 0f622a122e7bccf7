#include "apps/support/figures.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "coupling/common/child_process.hpp"
#include "coupling/common/errors.hpp"

namespace drumlin::apps {

void draw_figures(const std::string& script, const std::vector<std::string>& arguments) {
  ProcessRequest request;
  request.program = DRUMLIN_PYTHON;
  request.words = {(std::filesystem::path(DRUMLIN_FIGURES) / script).string()};
  request.words.insert(request.words.end(), arguments.begin(), arguments.end());
  // Agg draws without a display; threads in OpenBLAS cost more than they bring to a figure.
  request.environment = {"MPLBACKEND=Agg", "OPENBLAS_NUM_THREADS=1", "OMP_NUM_THREADS=1",
                         "PYTHONDONTWRITEBYTECODE=1"};
  // Standard output stays free for the command's own results (--json).
  request.output = ProcessOutput::with_errors;
  std::string said;
  request.line = [&](const std::string& line) { said += line + "\n"; };
  if (!run_process(request).succeeded())
    throw IoError(fmt::format("{} failed:\n{}", std::filesystem::path(script).filename().string(), said));
}

}  // namespace drumlin::apps
