// drumlin flow: starts drumlin-flow, which stands beside this executable, and ends as it ends.
#include "apps/flow/flow_options.hpp"
#include "apps/process/interruption.hpp"
#include "apps/process/program_files.hpp"
#include "coupling/core/machine/child_process.hpp"

namespace drumlin::apps {
namespace {

int flow(const FlowOptions& options) {
  ProcessRequest request{.program = program_beside("drumlin-flow"), .words = words_of(described(options))};
  request.caught = interruption;
  const CaughtInterruptions caught;  // the child ends by them, and we with it
  return run_process(request).shell_code();
}

}  // namespace

Command flow_command() { return flow_command(flow); }

}  // namespace drumlin::apps
