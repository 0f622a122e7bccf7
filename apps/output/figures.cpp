#include "apps/output/figures.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/process/interruption.hpp"
#include "apps/process/program_files.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/machine/child_process.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

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

void require_success(const ProcessEnd& end, const std::string& script, const std::string& said) {
  stop_if_interrupted();
  if (end.shell_code() == static_cast<int>(ExitCode::wrong_input))
    throw InputError(said.substr(0, said.find_last_not_of('\n') + 1));
  if (!end.succeeded())
    throw IoError(fmt::format("{} failed:\n{}", fs::path(script).filename().string(), said));
}

/// Runs a script and hands over what it printed.
ProcessEnd end_of_script(const std::string& script, const std::vector<std::string>& arguments,
                         std::string& said) {
  ProcessRequest request = request_for(script, arguments);
  // Standard output stays free for the command's own results (--json).
  request.line = [&](const std::string& line) { said += line + "\n"; };
  request.caught = interruption;
  const CaughtInterruptions caught;  // the script ends by them, and we with it
  const ProcessEnd end = run_process(request);
  stop_if_interrupted();
  return end;
}

}  // namespace

void draw_figures(const std::string& script, const std::vector<std::string>& arguments) {
  std::string said;
  const ProcessEnd end = end_of_script(script, arguments, said);
  require_success(end, script, said);
}

std::string study_by_script(const std::string& script, const std::vector<std::string>& arguments) {
  std::string said;
  const ProcessEnd end = end_of_script("../study/" + script, arguments, said);
  require_success(end, "study", said);
  return said;
}

void work_for_script(const std::string& script, const std::function<Json(const Json&)>& answer) {
  ProcessRequest request = request_for(script, {});
  const Pipe answers = open_pipe();  // to its standard input
  request.input = answers.out.number();
  std::string said;
  request.line = [&](const std::string& line) {
    stop_if_interrupted();
    if (!line.starts_with("{"))
      said += line + "\n";
    else if (!answers.in.write(answer(Json::parse(line)).dump() + "\n"))
      throw_io_error("a pipe", "written");
  };
  const CaughtInterruptions caught;  // what is at work takes notice, and the script ends with it
  require_success(run_process(request), script, said);
}

}  // namespace drumlin::apps
