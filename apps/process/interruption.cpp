#include "apps/process/interruption.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/unfinished_file.hpp"

namespace drumlin::apps {
namespace {

static_assert(exit_code_of(SIGHUP) == static_cast<int>(ExitCode::hung_up) &&
              exit_code_of(SIGINT) == static_cast<int>(ExitCode::interrupted) &&
              exit_code_of(SIGTERM) == static_cast<int>(ExitCode::terminated));

// The signal that came, and how many of those who want to be told so live.
volatile std::sig_atomic_t caught = 0, only_caught = 0;

extern "C" void take_signal(int signal) {
  if (only_caught != 0) {
    caught = signal;
    return;
  }
  remove_unfinished_files();
  ::_exit(exit_code_of(signal));
}

bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void end_at_signals() {
  // As it was when the program began: a library may have set a handler since.
  static const bool outlives_terminal = is_ignored(SIGHUP);
  struct sigaction action {};
  action.sa_handler = take_signal;
  action.sa_flags = SA_RESTART;  // a write that a signal meets goes on
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  if (outlives_terminal)
    std::signal(SIGHUP, SIG_IGN);
  else
    ::sigaction(SIGHUP, &action, nullptr);
  std::signal(SIGPIPE, SIG_DFL);
  std::signal(SIGXFSZ, SIG_IGN);
}

void end_with_parent() {
  const char* parent = std::getenv("DRUMLIN_PARENT");
  if (parent == nullptr) return;
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (std::to_string(::getppid()) != parent) std::raise(SIGTERM);  // it has gone before
  ::unsetenv("DRUMLIN_PARENT");                                    // those we start are not its children
}

void outlive_readers() { std::signal(SIGPIPE, SIG_IGN); }

CaughtInterruptions::CaughtInterruptions() {
  if (only_caught == 0) caught = 0;
  only_caught = only_caught + 1;
}

CaughtInterruptions::~CaughtInterruptions() { only_caught = only_caught - 1; }

int interruption() { return caught; }

void stop_if_interrupted() {
  if (const int signal = interruption()) throw Interrupted{exit_code_of(signal)};
}

}  // namespace drumlin::apps
