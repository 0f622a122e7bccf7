// The table of commands, in the order of the help, each with examples of its use: a new one is a file of this
// folder, which defines its options and NAME_command(), and its row here.
#include "apps/commands/all_commands.hpp"

// clang-format off
#define COMMANDS(row) \
  row(new_scene_command, "drumlin new drum -o drum.toml", "drumlin new drum-flow -o flow.toml") \
  row(run_command, "drumlin run drum-smoke -o RUN", "drumlin run drum.toml -o RUN --set stages.1.turns=2", "drumlin run RUN/scene.toml -o RUN --extend 4") \
  row(sweep_command, "drumlin sweep drum-smoke --vary effects.friction.grain_grain=0.2:0.4 --vary seed=1:2 --measure -o SWEEP") \
  row(measure_command, "drumlin measure RUN", "drumlin measure RUN --parts none --slice-width 10 --overwrite", "drumlin measure RUN1 RUN2 --at 0.1,0.2 -o FRAMES") \
  row(import_command, "drumlin import grains.toml -o RUN", "drumlin import --keys") \
  row(plot_command, "drumlin plot RUN --player", "drumlin plot RUN --color size --snapshot 10 -o PLOTS") \
  row(report_command, "drumlin report RUN") \
  row(export_command, "drumlin export RUN --vtu -o VTU") \
  row(history_command, "drumlin history RUN") \
  row(calibrate_command, "drumlin calibrate RUN -o rheology.toml", "drumlin calibrate RUN1 RUN2 --memory --amount -o rheology.toml") \
  row(law_command, "drumlin law --friction 0.3 --restitution 0.5 -o law.toml") \
  row(flow_command, "drumlin flow drum-smoke-flow --rheology rheology.toml -o FLOWRUN", "drumlin flow drum-6rpm-flow --rheology drum-6rpm -o FLOWRUN") \
  row(compare_command, "drumlin compare RUN FLOWRUN -o REPORT") \
  row(pair_command, "drumlin pair column-collapse-rough --law collapse-grains --case collapse -o PAIR") \
  row(infer_command, "drumlin infer QUESTION.toml -o ANSWER") \
  row(score_command, "drumlin score FLOWRUN --limits bed.toml -o SCORE") \
  row(scene_command, "drumlin scene list", "drumlin scene check drum.toml", "drumlin scene show drum-smoke", "cp $(drumlin scene file drum-smoke) drum.toml", "drumlin scene keys") \
  row(solve_contacts_command, "drumlin solve-contacts PROBLEM.h5 --solver nlgs -o SOLUTION.h5") \
  row(cost_command, "drumlin cost drum-smoke --statistics 0.5 -o COST") \
  row(info_command, "drumlin info RUN") \
  row(accept_command, "drumlin accept RUN --reason \"title corrected\"")
// clang-format on

namespace drumlin::apps {

#define DECLARATION(name, ...) Command name();
COMMANDS(DECLARATION)

namespace {

Command with_examples(Command command, std::vector<std::string> examples) {
  command.examples = std::move(examples);
  return command;
}

}  // namespace

#define CALL(name, ...) with_examples(name(), {__VA_ARGS__}),
std::vector<Command> all_commands() { return {COMMANDS(CALL)}; }

}  // namespace drumlin::apps
