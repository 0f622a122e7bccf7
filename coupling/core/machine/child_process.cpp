#include "coupling/core/machine/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <string_view>
#include <thread>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/descriptor.hpp"

extern char** environ;

namespace drumlin {
namespace {

namespace fs = std::filesystem;
constexpr std::chrono::milliseconds between_looks{5};

[[noreturn]] void fail(const fs::path& program, int error) {
  throw IoError(program.string() + ": " + std::strerror(error));
}

/// No started program inherits it.
struct Pipe {
  Descriptor out, in;
};
Pipe open_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("a pipe", errno);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// This process's environment with the settings in place of its own.
std::vector<std::string> environment_with(const std::vector<std::string>& settings) {
  std::vector<std::string> result = settings;
  for (char** entry = environ; *entry != nullptr; ++entry)
    if (std::none_of(settings.begin(), settings.end(), [&](const std::string& setting) {
          return std::string_view(*entry).starts_with(setting.substr(0, setting.find('=') + 1));
        }))
      result.emplace_back(*entry);
  return result;
}

/// Makes a child the other program. Nothing may be allocated between fork and exec.
[[noreturn]] void become(const ProcessRequest& request, char* const* words, char* const* variables,
                         int captured, int failed) {
  ::prctl(PR_SET_PDEATHSIG, request.end_signal);
  if (request.output != ProcessOutput::inherited) ::dup2(captured, STDOUT_FILENO);
  if (request.output == ProcessOutput::with_errors) ::dup2(captured, STDERR_FILENO);
  std::signal(SIGPIPE, SIG_DFL);
  ::execvpe(request.program.c_str(), words, variables);
  const int error = errno;
  (void)!::write(failed, &error, sizeof error);
  ::_exit(127);
}

pid_t started(const ProcessRequest& request, int captured) {
  std::vector<std::string> words = {request.program.string()};
  words.insert(words.end(), request.words.begin(), request.words.end());
  std::vector<std::string> variables = environment_with(request.environment);
  const std::vector<char*> word_pointers = pointers(words), variable_pointers = pointers(variables);
  Pipe failed = open_pipe();  // takes errno if there is no such program
  const pid_t process = ::fork();
  if (process == 0)
    become(request, word_pointers.data(), variable_pointers.data(), captured, failed.in.number());
  if (process < 0) fail(request.program, errno);
  (void)failed.in.close();
  int error = 0;
  if (::read(failed.out.number(), &error, sizeof error) == static_cast<ssize_t>(sizeof error)) {
    ::waitpid(process, nullptr, 0);
    fail(request.program, error);
  }
  return process;
}

/// A started program: passes on the signals that this process catches, and waits for its end.
class Child {
 public:
  Child(pid_t process, const ProcessRequest& request) : process_(process), request_(request) {}
  /// After an error of this process nobody wants its output any more.
  ~Child() {
    if (ended_) return;
    ::kill(process_, SIGTERM);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void pass_on_signals() {
    const int signal = request_.caught ? request_.caught() : 0;
    if (signal != std::exchange(passed_on_, signal)) ::kill(process_, signal);
  }

  ProcessEnd end() {
    int status = 0;
    for (;;) {
      const pid_t found = ::waitpid(process_, &status, WNOHANG);
      if (found == process_) break;
      if (found < 0 && errno != EINTR) fail(request_.program, errno);
      pass_on_signals();
      std::this_thread::sleep_for(between_looks);
    }
    ended_ = true;
    return WIFEXITED(status) ? ProcessEnd{.exit_code = WEXITSTATUS(status)}
                             : ProcessEnd{.signal = WTERMSIG(status)};
  }

 private:
  pid_t process_;
  const ProcessRequest& request_;
  int passed_on_ = 0;
  bool ended_ = false;
};

void hand_over_lines(int file, Child& child, const std::function<void(const std::string&)>& line) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    pollfd ready{file, POLLIN, 0};
    const int count_ready = ::poll(&ready, 1, static_cast<int>(between_looks.count()));
    child.pass_on_signals();
    if (count_ready <= 0) continue;  // a signal, or nothing yet
    const ssize_t count = ::read(file, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(count));
    for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1))
      line(text.substr(0, end));
  }
  if (!text.empty()) line(text);
}

}  // namespace

ProcessEnd run_process(const ProcessRequest& request) {
  Pipe output = open_pipe();
  Child child(started(request, output.in.number()), request);
  (void)output.in.close();
  if (request.output != ProcessOutput::inherited) hand_over_lines(output.out.number(), child, request.line);
  return child.end();
}

}  // namespace drumlin
