#pragma once
// Programs that this one starts: how they are started, what they print, how they end.
#include <csignal>
#include <filesystem>
#include <functional>
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
  ProcessOutput output = ProcessOutput::inherited;
  std::function<void(const std::string&)> line = [](const std::string&) {};  ///< takes captured output
  /// Tells the signal that this process has caught, 0: none. The program gets it too, and this process waits
  /// for its end.
  int (*caught)() = nullptr;
  /// What the program gets when this process ends before it, by kill -9 for example: nobody would wait for it
  /// any more. SIGTERM for one that has processes of its own to end (mpirun).
  int end_signal = SIGKILL;
};

/// How a program ended.
struct ProcessEnd {
  int exit_code = 0;  ///< its own, where no signal ended it
  int signal = 0;     ///< the one that ended it; 0: none
  bool succeeded() const { return exit_code == 0 && signal == 0; }
  /// The exit code, or 128 + signal as a shell reports it.
  int shell_code() const { return signal == 0 ? exit_code : 128 + signal; }
};

/// Starts the program and waits until it ends. Throws IoError if it cannot be started. To be called from a
/// thread that lives on: the program ends with it.
ProcessEnd run_process(const ProcessRequest& request);

}  // namespace drumlin
