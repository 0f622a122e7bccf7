#include "apps/output/figures.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/process/interruption.hpp"
#include "apps/process/program_files.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/machine/child_process.hpp"

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
  if (!end.succeeded())
    throw IoError(fmt::format("{} failed:\n{}", fs::path(script).filename().string(), said));
}

/// A pipe to the standard input of a script.
class Answers {
 public:
  Answers() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) throw IoError(fmt::format("a pipe: {}", std::strerror(errno)));
  }
  ~Answers() {
    for (const int end : ends_) ::close(end);
  }
  Answers(const Answers&) = delete;
  Answers& operator=(const Answers&) = delete;
  int read_end() const { return ends_[0]; }
  void write(const std::string& text) const {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t count = ::write(ends_[1], text.data() + done, text.size() - done);
      if (count < 0 && errno != EINTR) throw IoError(fmt::format("a pipe: {}", std::strerror(errno)));
      done += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
    }
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

/// Runs a script and hands over what it printed.
ProcessEnd end_of_script(const std::string& script, const std::vector<std::string>& arguments,
                         std::string& said) {
  ProcessRequest request = request_for(script, arguments);
  // Standard output stays free for the command's own results (--json).
  request.line = [&](const std::string& line) { said += line + "\n"; };
  request.pass_signals_on = true;
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

std::string study_by_script(const std::vector<std::string>& arguments) {
  std::string said;
  const ProcessEnd end = end_of_script("../study/command.py", arguments, said);
  if (end.shell_code() == static_cast<int>(ExitCode::wrong_input))
    throw InputError(said.substr(0, said.find_last_not_of('\n') + 1));
  require_success(end, "study", said);
  return said;
}

void work_for_script(const std::string& script, const std::function<Json(const Json&)>& answer) {
  ProcessRequest request = request_for(script, {});
  const Answers answers;
  request.input = answers.read_end();
  std::string said;
  request.line = [&](const std::string& line) {
    stop_if_interrupted();
    if (line.starts_with("{"))
      answers.write(answer(Json::parse(line)).dump() + "\n");
    else
      said += line + "\n";
  };
  const CaughtInterruptions caught;  // what is at work takes notice, and the script ends with it
  require_success(run_process(request), script, said);
}

}  // namespace drumlin::apps
