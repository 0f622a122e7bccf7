// drumlin run --ranks: starts drumlin-run, which stands beside this executable, by mpirun, and ends as it
// ends.
#include "apps/commands/run.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "apps/process/interruption.hpp"
#include "apps/process/program_files.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/machine/child_process.hpp"

namespace drumlin::apps {
namespace {

std::vector<std::string> words_for(RunOptions options) {
  const int ranks = *std::exchange(options.ranks, std::nullopt);
  options.threads = std::max(1, options.threads / ranks);
  std::vector<std::string> words = {"-n", std::to_string(ranks), program_beside("drumlin-run").string()};
  const std::vector<std::string> of_rank = words_of(described(options));
  words.insert(words.end(), of_rank.begin(), of_rank.end());
  return words;
}

}  // namespace

int run_by_mpirun(const RunOptions& options) {
  ProcessRequest request{.program = "mpirun", .words = words_for(options)};
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
  // mpirun ends with 1 when it is told to end.
  return interruption() != 0 && !end.succeeded() ? exit_code_of(interruption()) : end.shell_code();
}

}  // namespace drumlin::apps
