#pragma once
// What every program does around its own work: streams, signals, errors to exit codes, a check of its output.
#include <functional>

namespace drumlin::apps {

/// Processors that this process may use, most_threads at most.
int processors_at_hand();

/// Does `work` and returns the exit code of the program (ExitCode): that of `work`, or that of what it threw,
/// after a message on standard error where `speaks` says so (of several processes one speaks). Output that
/// could not be written makes it input_output; where its reader has gone the process ends by SIGPIPE. An
/// error that nobody can catch, in another thread, ends the process with its message and code too.
int run_program(
    const std::function<int()>& work, const std::function<bool()>& speaks = [] { return true; });

}  // namespace drumlin::apps
