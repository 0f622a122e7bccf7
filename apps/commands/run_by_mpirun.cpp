// drumlin run --ranks: starts drumlin-run, which stands beside this executable, by mpirun, and ends as it
// ends.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "apps/output/commands.hpp"
#include "apps/process/interruption.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/machine/child_process.hpp"
#include "coupling/core/machine/system_limits.hpp"

namespace drumlin::apps {
namespace {

std::vector<std::string> words_of(const RunOptions& options) {
  const int ranks = *options.ranks;
  std::vector<std::string> words = {"-n", std::to_string(ranks), program_beside("drumlin-run").string()};
  if (!options.scene.empty()) words.push_back(options.scene.string());
  words.insert(words.end(), {"-o", options.output.string()});
  words.insert(words.end(), {"--threads", std::to_string(std::max(1, options.threads / ranks))});
  for (const std::string& change : options.overrides) words.insert(words.end(), {"--set", change});
  if (options.accuracy) words.insert(words.end(), {"--accuracy", options.accuracy->string()});
  const auto seconds = [&](const char* option, double number) {
    if (number > 0) words.insert(words.end(), {option, fmt::format("{}", number)});
  };
  seconds("--accuracy-seconds", options.accuracy_seconds);
  seconds("--extend", options.extend_seconds);
  if (options.existing == ExistingOutput::resume) words.push_back("--resume");
  if (options.existing == ExistingOutput::overwrite) words.push_back("--overwrite");
  return words;
}

constexpr int files_of_mpirun = 32, files_of_rank = 16;

}  // namespace

int run_by_mpirun(const RunOptions& options) {
  ProcessRequest request{.program = "mpirun", .words = words_of(options)};
  require_open_files(files_of_mpirun + files_of_rank * *options.ranks);
  request.environment = {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"};
  if (*options.ranks > processors_at_hand()) {  // who waits leaves its processor to others
    request.environment.push_back("OMPI_MCA_rmaps_base_oversubscribe=1");
    request.environment.push_back("OMPI_MCA_mpi_yield_when_idle=1");
  }
  if (std::getenv("PATH") == nullptr)  // mpirun, which is then looked for there, does not do without
    request.environment.push_back("PATH=/usr/bin:/bin");
  request.caught = interruption;
  request.end_signal = SIGTERM;      // it ends its ranks
  const CaughtInterruptions caught;  // the job ends by them, and we with it
  const ProcessEnd end = run_process(request);
  require_loaded(end, "drumlin-run");
  // mpirun ends with 1 when it is told to end.
  return interruption() != 0 && !end.succeeded() ? exit_code_of(interruption()) : end.shell_code();
}

}  // namespace drumlin::apps
