// drumlin-flow: the continuum solve as a program of its own, so that `drumlin` starts without loading
// deal.II. It takes the words of `drumlin flow`, whose command line it shares; `drumlin-flow --keys
// [--markdown]` lists the keys of a flow scene, `--version` says which program this is.
#include <cstring>
#include <variant>

#include "apps/command_line/command_line.hpp"
#include "apps/flow/flow_run.hpp"
#include "apps/output/program.hpp"
#include "apps/process/interruption.hpp"
#include "apps/process/standard_streams.hpp"
#include "continuum/fem/runtime.hpp"
#include "continuum/model/flow_scene.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/provenance.hpp"
#include "coupling/core/machine/first_rank.hpp"

#if defined(__SANITIZE_ADDRESS__)
// OpenMPI and the libraries behind PETSc keep memory until the process ends; the leak check would count it as
// ours.
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }
#endif

namespace {

using namespace drumlin;

/// `speaks`: whether this process is the first rank, who speaks for all.
int solve(int argc, char** argv, bool& speaks) {
  if (argc > 1 && std::strcmp(argv[1], "--keys") == 0) {
    const bool markdown = argc > 2 && std::strcmp(argv[2], "--markdown") == 0;
    apps::print_out(markdown ? keys_as_markdown(continuum::flow_scene_keys())
                             : keys_as_text(continuum::flow_scene_keys()));
    return static_cast<int>(ExitCode::done);
  }
  if (argc > 1 && std::strcmp(argv[1], "--version") == 0) {
    apps::print_out("drumlin-flow " + version_text() + "\n");
    return static_cast<int>(ExitCode::done);
  }
  const auto request = apps::parse_options<apps::FlowOptions>(argc, argv, apps::flow_command(nullptr));
  if (const auto* shown = std::get_if<apps::TextToShow>(&request)) {
    apps::print_out(shown->text);
    return static_cast<int>(ExitCode::done);
  }
  const continuum::FemRuntime runtime(argc, argv);
  speaks = runtime.rank() == 0;
  apps::end_at_signals();  // PETSc has set handlers of its own
  apps::outlive_readers();
  try {
    const int code = apps::solve_flow_scene(std::get<apps::FlowOptions>(request), runtime);
    apps::flush_out();  // PETSc flushes it at its end, too, and what fails then is nobody's
    return code;
  } catch (const FailedOnFirstRank& failure) {
    return static_cast<int>(failure.code);
  }
}

}  // namespace

int main(int argc, char** argv) {
  bool speaks = true;
  return drumlin::apps::run_program([&] { return solve(argc, argv, speaks); }, [&] { return speaks; });
}
