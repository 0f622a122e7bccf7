#pragma once
// Programs that this one starts: how they are started, what they print, how they end.
#include <csignal>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace drumlin {

/// Where the output of a started program goes.
enum class ProcessOutput {
  inherited,    ///< both streams where those of this process go
  standard,     ///< standard output to `line`, errors where those of this process go
  with_errors,  ///< both to `line`, in the order in which they come
};

/// A program to be started, and what it is given.
struct ProcessRequest {
  std::filesystem::path program;  ///< a path, or a name to be found along PATH
  std::vector<std::string> words = {};
  std::vector<std::string> environment = {};  ///< "NAME=value", in place of this process's own value of NAME
  int input = -1;                             ///< what it reads as standard input; -1: that of this process
  ProcessOutput output = ProcessOutput::inherited;
  std::function<void(const std::string&)> line =
      {};                                   ///< takes each line of captured output; empty: it is dropped
  std::optional<double> time_limit_s = {};  ///< wall time after which the program is told to end
  /// SIGINT, SIGTERM and SIGHUP go to the program too, and this process, after its own handler, which must
  /// return, waits for its end.
  bool pass_signals_on = false;
  /// What the program gets when this process ends before it, by kill -9 for example: nobody would wait for it
  /// any more. SIGTERM for one that has processes of its own to end (mpirun).
  int end_signal = SIGKILL;
};

/// How a program ended.
struct ProcessEnd {
  int exit_code = 0;          ///< its own, where no signal ended it
  int signal = 0;             ///< the one that ended it; 0: none
  bool timed_out = false;     ///< it was told to end at its time limit
  double peak_memory_mb = 0;  ///< largest resident set, MiB; of mpirun the largest of its ranks
  bool succeeded() const { return exit_code == 0 && signal == 0 && !timed_out; }
  /// The exit code, or 128 + signal as a shell reports it.
  int shell_code() const { return signal == 0 ? exit_code : 128 + signal; }
};

/// Starts the program and waits until it ends. Throws IoError if it cannot be started. At most one call of a
/// process at a time passes signals on. To be called from a thread that lives on: the program ends with it.
ProcessEnd run_process(const ProcessRequest& request);

/// Throws IoError where the system could not load a program of ours (exit code 127, after words of the
/// loader).
void require_loaded(const ProcessEnd& end, const std::string& name);

/// Does `work` in a copy of this process, whose memory can then be told from this one's, and waits for it.
/// Throws IoError if there can be no copy.
ProcessEnd run_in_copy(const std::function<void()>& work);

/// The program of this name in the folder of the running executable. Throws IoError if it is missing.
std::filesystem::path program_beside(const std::string& name);

}  // namespace drumlin
