// drumlin flow: starts drumlin-flow, which stands beside this executable, and ends as it ends.
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "apps/commands.hpp"
#include "apps/support/child_process.hpp"
#include "coupling/exchange/errors.hpp"

extern char** environ;

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

volatile std::sig_atomic_t child = 0;
extern "C" void pass_on(int signal) {
  if (child > 0) ::kill(child, signal);
}

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

/// Waits through the signals that are passed on meanwhile.
int exit_code_of(pid_t process, const fs::path& program) {
  int status = 0;
  while (::waitpid(process, &status, 0) < 0)
    if (errno != EINTR) throw IoError(fmt::format("{}: {}", program.string(), std::strerror(errno)));
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  return 128 + WTERMSIG(status);  // as a shell reports it
}

}  // namespace

int flow(const FlowOptions& options) {
  const fs::path program = program_beside("drumlin-flow");
  std::vector<std::string> words = words_of(options);
  words.insert(words.begin(), program.string());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  pid_t process = 0;
  const int error = ::posix_spawn(&process, program.c_str(), nullptr, nullptr, arguments.data(), environ);
  if (error != 0) throw IoError(fmt::format("{}: {}", program.string(), std::strerror(error)));
  child = process;
  std::signal(SIGINT, pass_on);
  std::signal(SIGTERM, pass_on);
  const int code = exit_code_of(process, program);
  child = 0;
  return code;
}

}  // namespace drumlin::apps
