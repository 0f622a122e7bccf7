// drumlin-flow: the continuum solve as a program of its own, so that `drumlin` starts without loading
// deal.II. It takes the words of `drumlin flow`, whose command line it shares; `drumlin-flow --keys
// [--markdown]` lists the keys of a flow scene, `--hardcases` runs cases for `drumlin hardcases`.
#include <fmt/format.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "apps/command_line/command_line.hpp"
#include "apps/flow/flow_hardcases.hpp"
#include "apps/flow/flow_run.hpp"
#include "continuum/fem/runtime.hpp"
#include "continuum/model/flow_scene.hpp"
#include "coupling/common/errors.hpp"

#if defined(__SANITIZE_ADDRESS__)
// OpenMPI and the libraries behind PETSc keep memory until the process ends; the leak check would count it as
// ours.
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }
#endif

namespace {

using namespace drumlin;

bool speaks = true;  // the first rank, for all

int failed(ExitCode code, const std::string& message) {
  std::fflush(stdout);
  if (speaks) fmt::print(stderr, "{}\n", message);
  return static_cast<int>(code);
}

int solve(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--keys") == 0) {
    const bool markdown = argc > 2 && std::strcmp(argv[2], "--markdown") == 0;
    fmt::print("{}", markdown ? keys_as_markdown(continuum::flow_scene_keys())
                              : keys_as_text(continuum::flow_scene_keys()));
    return static_cast<int>(ExitCode::done);
  }
  if (argc > 1 && std::strcmp(argv[1], "--hardcases") == 0) {
    const continuum::FemRuntime runtime(argc, argv);
    return apps::flow_hardcases({argv + 2, argv + argc});
  }
  std::vector<const char*> words = {"drumlin", "flow"};
  words.insert(words.end(), argv + 1, argv + argc);
  const auto request = apps::parse_command_line(static_cast<int>(words.size()), words.data(), {});
  if (const auto* shown = std::get_if<apps::TextToShow>(&request)) {
    fmt::print("{}", shown->text);
    return static_cast<int>(ExitCode::done);
  }
  const continuum::FemRuntime runtime(argc, argv);
  speaks = runtime.rank() == 0;
  try {
    return apps::solve_flow_scene(std::get<apps::FlowOptions>(request), runtime);
  } catch (const continuum::FailedOnFirstRank& failure) {
    return static_cast<int>(failure.code);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return solve(argc, argv);
  } catch (const InputError& error) {
    return failed(ExitCode::wrong_input, error.what());
  } catch (const NotConvergedError& error) {
    return failed(ExitCode::not_converged, error.what());
  } catch (const IoError& error) {
    return failed(ExitCode::input_output, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return failed(ExitCode::input_output, error.what());
  }
}
