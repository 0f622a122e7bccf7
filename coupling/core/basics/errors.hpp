#pragma once
// The kinds of failure that a user can meet. Libraries throw them, only apps/ turns them into an exit code.
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace drumlin {

/// One fault of an input: where it stands, which key, what is wrong and what would be allowed.
/// line and column count from 1; 0 means that the fault has no place in a file (a command-line override,
/// say).
struct InputProblem {
  std::string file;
  int line = 0;
  int column = 0;
  std::string key;
  std::string what;
  std::string allowed;  ///< empty when there is nothing to add
  /// "file:line:column: key: what (allowed: ...)"
  std::string text() const;
};

/// Wrong usage or wrong input, all its problems at once; exit code 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<InputProblem> problems);
  explicit InputError(const std::string& message);
  const std::vector<InputProblem>& problems() const { return problems_; }

 private:
  std::vector<InputProblem> problems_;
};

/// What a reader found; throws InputError with all problems if there are any.
template <class T>
T accepted(T value, const std::vector<InputProblem>& problems) {
  if (!problems.empty()) throw InputError(problems);
  return value;
}

/// A method did not converge, or no steady solution exists; exit code 3.
class NotConvergedError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file could not be read or written; exit code 74.
class IoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws the IoError "FILE: cannot be WHAT: why", why from errno.
[[noreturn]] void throw_io_error(const std::filesystem::path& file, const std::string& what);

/// Exit codes of every program (docs/conventions.md).
enum class ExitCode : int {
  done = 0,
  wrong_input = 2,
  not_converged = 3,
  fault = 70,  ///< the program is wrong: EX_SOFTWARE of sysexits.h
  input_output = 74,
  hung_up = 129,  ///< this and the next two: 128 + signal, as a shell reports it
  interrupted = 130,
  terminated = 143
};

}  // namespace drumlin
