// drumlin-run: `drumlin run` on the ranks that mpirun starts, `mpirun -n N drumlin-run SCENE -o RUN`. It
// takes the words of `drumlin run`, whose command line it shares; the results do not depend on N.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "apps/command_line/command_line.hpp"
#include "apps/run/rank_run.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/program.hpp"
#include "apps/support/standard_streams.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/first_rank.hpp"
#include "coupling/common/provenance.hpp"
#include "coupling/common/unfinished_file.hpp"
#include "particles/distributed/ranks.hpp"

#if defined(__SANITIZE_ADDRESS__)
// OpenMPI and the libraries behind deal.II keep memory until the process ends; the leak check would count it
// as ours.
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }
#endif

namespace {

using namespace drumlin;

/// What one rank meets alone would leave the others waiting for ever.
[[noreturn]] void end_all(const particles::Ranks& ranks, const char* message, ExitCode code) {
  remove_unfinished_files();
  apps::print_error(fmt::format("rank {} of {}: {}\n", ranks.rank(), ranks.count(), message));
  particles::Ranks::end_all(static_cast<int>(code));
}

int run_together(const apps::RunOptions& options, const particles::Ranks& ranks) {
  try {
    return apps::run_on_ranks(options, ranks);
  } catch (const FailedOnFirstRank& failure) {
    return static_cast<int>(failure.code);
  } catch (
      const InputError&) {  // these two are met by all ranks, or by the first alone, which tells the others
    throw;
  } catch (const NotConvergedError&) {
    throw;
  } catch (const std::exception& error) {
    if (ranks.count() == 1) throw;
    const bool of_files = dynamic_cast<const IoError*>(&error) || dynamic_cast<const std::bad_alloc*>(&error);
    end_all(ranks, error.what(), of_files ? ExitCode::input_output : ExitCode::fault);
  }
}

/// The help of `drumlin run` under the name of this program, without the option that starts it.
std::string under_our_name(std::string help) {
  const std::string usage = "Usage: drumlin run", ranks = "\n  --ranks", next = "\n  -";
  if (const auto at = help.find(usage); at != std::string::npos)
    help.replace(at, usage.size(), "Usage: mpirun -n RANKS drumlin-run");
  if (const auto at = help.find(ranks); at != std::string::npos) help.erase(at, help.find(next, at + 1) - at);
  return help;
}

/// `speaks`: whether this process is the first rank, who speaks for all.
int run(int argc, char** argv, bool& speaks) {
  std::vector<const char*> words = {"drumlin", "run"};
  words.insert(words.end(), argv + 1, argv + argc);
  const particles::RankRuntime runtime(argc, argv);
  const particles::Ranks ranks;
  speaks = ranks.rank() == 0;
  apps::end_at_signals();  // the libraries have set handlers of their own
  apps::outlive_readers();
  if (argc > 1 && std::strcmp(argv[1], "--version") == 0) {
    if (speaks) apps::print_out("drumlin-run " + version_text() + "\n");
    return static_cast<int>(ExitCode::done);
  }
  try {
    ranks.require_same(fmt::format("{}", fmt::join(words, "\n")), "words of the call are");
  } catch (const FailedOnFirstRank& failure) {
    return static_cast<int>(failure.code);
  }
  const auto request = apps::parse_command_line(static_cast<int>(words.size()), words.data(), {});
  if (const auto* shown = std::get_if<apps::TextToShow>(&request)) {
    if (speaks) apps::print_out(under_our_name(shown->text));
    return static_cast<int>(ExitCode::done);
  }
  return run_together(std::get<apps::RunOptions>(request), ranks);
}

}  // namespace

int main(int argc, char** argv) {
  bool speaks = true;
  return drumlin::apps::run_program([&] { return run(argc, argv, speaks); }, [&] { return speaks; });
}
