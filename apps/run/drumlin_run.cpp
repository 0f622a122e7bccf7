// drumlin-run: `drumlin run` on the ranks that mpirun starts, `mpirun -n N drumlin-run SCENE -o RUN`. It
// takes the words of `drumlin run`; the results do not depend on N.
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apps/command_line/command_line.hpp"
#include "apps/commands/followers.hpp"
#include "apps/commands/run.hpp"
#include "apps/output/program.hpp"
#include "apps/process/interruption.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/provenance.hpp"
#include "particles/distributed/mpi_world.hpp"

#if defined(__SANITIZE_ADDRESS__)
// OpenMPI keeps memory until the process ends; the leak check would count it as ours.
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }
#endif

namespace {

using namespace drumlin;

/// The help of `drumlin run` under the name of this program, without the option that starts it.
std::string under_our_name(std::string help) {
  const std::string usage = "Usage: drumlin run", ranks = "\n  --ranks", next = "\n  -";
  if (const auto at = help.find(usage); at != std::string::npos)
    help.replace(at, usage.size(), "Usage: mpirun -n RANKS drumlin-run");
  if (const auto at = help.find(ranks); at != std::string::npos) help.erase(at, help.find(next, at + 1) - at);
  return help;
}

/// What the first rank does, whose words count.
int run(int argc, char** argv, particles::World& world) {
  if (argc > 1 && std::strcmp(argv[1], "--version") == 0) {
    apps::print_out("drumlin-run " + version_text() + "\n");
    return 0;
  }
  const auto request = apps::parse_options<apps::RunOptions>(argc, argv, apps::run_command());
  if (const auto* shown = std::get_if<apps::TextToShow>(&request)) {
    apps::print_out(under_our_name(shown->text));
    return 0;
  }
  apps::outlive_readers();
  return apps::run(std::get<apps::RunOptions>(request), &world);
}

/// Another rank's work. What it meets alone would leave the others waiting for ever.
int follow(particles::World& world) {
  const auto end_all = [&](const char* what, ExitCode code) {
    apps::print_error("rank " + std::to_string(world.rank()) + ": " + what + "\n");
    world.end_all(static_cast<int>(code));
  };
  try {
    return apps::follow(world);
  } catch (const std::bad_alloc&) {
    end_all("not enough memory", ExitCode::input_output);
  } catch (const std::exception& error) {
    end_all(error.what(), ExitCode::fault);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace drumlin;
  bool speaks = true;
  std::optional<particles::MpiWorld> world;
  const int code = apps::run_program(
      [&] {
        world.emplace();
        speaks = world->rank() == 0;
        apps::end_at_signals();  // the library has set handlers of its own
        return speaks ? run(argc, argv, *world) : follow(*world);
      },
      [&] { return speaks; });
  if (world && speaks) apps::Followers(&*world).end(code);
  return code;
}
