// The table of commands, in the order of the help: a new one is a file of this folder, which defines its
// options and NAME_command(), and its row here.
#include "apps/commands/all_commands.hpp"

// clang-format off
#define COMMANDS(row) \
  row(new_scene_command) \
  row(run_command) \
  row(sweep_command) \
  row(measure_command) \
  row(import_command) \
  row(plot_command) \
  row(report_command) \
  row(export_command) \
  row(history_command) \
  row(calibrate_command) \
  row(law_command) \
  row(flow_command) \
  row(compare_command) \
  row(pair_command) \
  row(infer_command) \
  row(score_command) \
  row(scene_command) \
  row(solve_contacts_command) \
  row(cost_command) \
  row(info_command) \
  row(accept_command)
// clang-format on

namespace drumlin::apps {

#define DECLARATION(name) Command name();
COMMANDS(DECLARATION)

#define CALL(name) name(),
std::vector<Command> all_commands() { return {COMMANDS(CALL)}; }

}  // namespace drumlin::apps
