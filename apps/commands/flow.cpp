// drumlin flow: starts drumlin-flow, which stands beside this executable, and ends as it ends.
#include "apps/output/commands.hpp"
#include "apps/process/interruption.hpp"
#include "coupling/core/machine/child_process.hpp"

namespace drumlin::apps {
namespace {

std::vector<std::string> words_of(const FlowOptions& options) {
  std::vector<std::string> words = {options.scene.string(), "--rheology", options.rheology.string(), "-o",
                                    options.output.string()};
  if (options.from) words.insert(words.end(), {"--from", options.from->string()});
  for (const std::string& change : options.overrides) words.insert(words.end(), {"--set", change});
  words.insert(words.end(), {"--law-draws", std::to_string(options.law_draws)});
  if (options.existing == ExistingOutput::resume) words.push_back("--resume");
  if (options.existing == ExistingOutput::overwrite) words.push_back("--overwrite");
  return words;
}

}  // namespace

int flow(const FlowOptions& options) {
  ProcessRequest request{.program = program_beside("drumlin-flow"), .words = words_of(options)};
  request.caught = interruption;
  const CaughtInterruptions caught;  // the child ends by them, and we with it
  const ProcessEnd end = run_process(request);
  require_loaded(end, "drumlin-flow");
  return end.shell_code();
}

}  // namespace drumlin::apps
