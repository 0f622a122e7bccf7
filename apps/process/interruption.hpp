#pragma once
// SIGINT, SIGTERM and SIGHUP: what ends a program, or only tells a run to leave a checkpoint and end.
namespace drumlin::apps {

/// From now on the three signals end the process with 128 + signal, and remove its unfinished files first;
/// SIGHUP stays ignored where it was (nohup). A reader of our output that goes away ends the process by
/// SIGPIPE, as any other tool; a limit on the size of files only makes writes fail. Called at the start of a
/// program, and again after a library that sets handlers of its own.
void end_at_signals();

/// From now on SIGTERM comes when the process ends whose number the variable DRUMLIN_PARENT holds, if it is
/// our parent: a worker of the Python package that is killed leaves no run behind that nobody waits for.
void end_with_parent();

/// From now on a reader of our output that has gone ends the process no longer: for work whose results are
/// files.
void outlive_readers();

/// While it lives, the three signals only set a flag.
class CaughtInterruptions {
 public:
  CaughtInterruptions();
  ~CaughtInterruptions();
  CaughtInterruptions(const CaughtInterruptions&) = delete;
  CaughtInterruptions& operator=(const CaughtInterruptions&) = delete;
};

/// The signal that was caught, 0 if none.
int interruption();

/// Thrown out of work that a caught signal ends; carries the exit code of the program.
struct Interrupted {
  int exit_code;
};
/// Throws Interrupted if a signal was caught.
void stop_if_interrupted();

/// As a shell reports a process that the signal ended.
constexpr int exit_code_of(int signal) { return 128 + signal; }

}  // namespace drumlin::apps
