#include "coupling/common/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
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

#include "coupling/common/errors.hpp"

extern char** environ;

namespace drumlin {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double grace_s = 10;  // between SIGTERM at the time limit and SIGKILL

[[noreturn]] void fail(const fs::path& program, int error) {
  throw IoError(program.string() + ": " + std::strerror(error));
}

// What a signal handler can see: the child, what came before it was known, and the handlers of before.
volatile std::sig_atomic_t child = 0, waiting = 0;
struct sigaction interrupt_before {};
struct sigaction terminate_before {};

extern "C" void pass_on(int signal) {
  if (child > 0)
    ::kill(child, signal);
  else
    waiting = signal;
  const struct sigaction& before = signal == SIGINT ? interrupt_before : terminate_before;
  if (before.sa_handler != SIG_DFL && before.sa_handler != SIG_IGN) before.sa_handler(signal);
}

/// Passes signals on to a process while it lives; from before it is started, so that none is lost.
class PassingOn {
 public:
  PassingOn() {
    child = 0;
    waiting = 0;
    struct sigaction action {};
    action.sa_handler = pass_on;
    ::sigaction(SIGINT, &action, &interrupt_before);
    ::sigaction(SIGTERM, &action, &terminate_before);
  }
  ~PassingOn() {
    ::sigaction(SIGINT, &interrupt_before, nullptr);
    ::sigaction(SIGTERM, &terminate_before, nullptr);
    child = 0;
  }
  void to(pid_t process) {
    child = process;
    if (waiting != 0) ::kill(process, waiting);
  }
  PassingOn(const PassingOn&) = delete;
  PassingOn& operator=(const PassingOn&) = delete;
};

/// A pipe whose ends are closed with the scope; a started program inherits neither.
class Pipe {
 public:
  explicit Pipe(const fs::path& program) {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) fail(program, errno);
  }
  ~Pipe() {
    ::close(ends_[0]);
    close_write_end();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  void close_write_end() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// This process's environment with the settings in place of its own.
std::vector<std::string> environment_with(const std::vector<std::string>& settings) {
  std::vector<std::string> result = settings;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    bool replaced = false;
    for (const std::string& setting : settings)
      replaced |= text.starts_with(setting.substr(0, setting.find('=') + 1));
    if (!replaced) result.emplace_back(text);
  }
  return result;
}

pid_t started(const ProcessRequest& request, const Pipe& pipe) {
  std::vector<std::string> words = {request.program.string()};
  words.insert(words.end(), request.words.begin(), request.words.end());
  std::vector<std::string> variables = environment_with(request.environment);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  if (request.output != ProcessOutput::inherited)
    ::posix_spawn_file_actions_adddup2(&actions, pipe.write_end(), STDOUT_FILENO);
  if (request.output == ProcessOutput::with_errors)
    ::posix_spawn_file_actions_adddup2(&actions, pipe.write_end(), STDERR_FILENO);
  pid_t process = 0;
  const int error = ::posix_spawnp(&process, request.program.c_str(), &actions, nullptr,
                                   pointers(words).data(), pointers(variables).data());
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) fail(request.program, error);
  return process;
}

/// Tells a process to end when its time is over, and ends it if it does not.
class TimeLimit {
 public:
  TimeLimit(const std::optional<double>& seconds, pid_t process) : process_(process) {
    if (seconds) next_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(Duration(*seconds));
  }
  bool passed() const { return told_; }
  /// To the next signal, for poll(): -1 where there is no limit.
  int milliseconds() const {
    if (!next_) return -1;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(*next_ - Clock::now()).count();
    return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1000 * 3600));
  }
  void look() {
    if (!next_ || Clock::now() < *next_) return;
    ::kill(process_, told_ ? SIGKILL : SIGTERM);
    next_ =
        told_ ? std::nullopt
              : std::optional(Clock::now() + std::chrono::duration_cast<Clock::duration>(Duration(grace_s)));
    told_ = true;
  }

 private:
  using Duration = std::chrono::duration<double>;
  pid_t process_;
  std::optional<Clock::time_point> next_;
  bool told_ = false;
};

void hand_over_lines(int file, TimeLimit& limit, const std::function<void(const std::string&)>& line) {
  const auto hand_over = [&](const std::string& text) {
    if (line) line(text);
  };
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    pollfd ready{file, POLLIN, 0};
    const int count_ready = ::poll(&ready, 1, limit.milliseconds());
    limit.look();
    if (count_ready <= 0) continue;  // a signal, or the time
    const ssize_t count = ::read(file, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(count));
    for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1))
      hand_over(text.substr(0, end));
  }
  if (!text.empty()) hand_over(text);
}

ProcessEnd end_of(pid_t process, const fs::path& program, TimeLimit& limit) {
  int status = 0;
  rusage usage{};
  for (;;) {
    const bool endless = limit.milliseconds() < 0;
    const pid_t found = ::wait4(process, &status, endless ? 0 : WNOHANG, &usage);
    if (found == process) break;
    if (found < 0 && errno != EINTR) fail(program, errno);
    limit.look();
    if (!endless) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ProcessEnd end;
  if (WIFEXITED(status))
    end.exit_code = WEXITSTATUS(status);
  else
    end.signal = WTERMSIG(status);
  end.timed_out = limit.passed();
  end.peak_memory_mb = static_cast<double>(usage.ru_maxrss) / 1024;
  return end;
}

/// Waits for a process whose output nobody wants any more, after an error of this one.
class Reaped {
 public:
  explicit Reaped(pid_t process) : process_(process) {}
  ~Reaped() {
    if (process_ <= 0) return;
    ::kill(process_, SIGTERM);
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
  }
  Reaped(const Reaped&) = delete;
  Reaped& operator=(const Reaped&) = delete;
  void release() { process_ = 0; }

 private:
  pid_t process_;
};

}  // namespace

ProcessEnd run_process(const ProcessRequest& request) {
  Pipe pipe(request.program);
  std::optional<PassingOn> signals;
  if (request.pass_signals_on) signals.emplace();
  const pid_t process = started(request, pipe);
  if (signals) signals->to(process);
  pipe.close_write_end();
  Reaped reaped(process);
  TimeLimit limit(request.time_limit_s, process);
  if (request.output != ProcessOutput::inherited) hand_over_lines(pipe.read_end(), limit, request.line);
  reaped.release();
  return end_of(process, request.program, limit);
}

ProcessEnd run_in_copy(const std::function<void()>& work) {
  const pid_t process = ::fork();
  if (process < 0) fail("a copy of this process", errno);
  if (process == 0) {
    int code = 0;
    try {
      work();
    } catch (...) {
      code = 1;
    }
    ::_exit(code);
  }
  TimeLimit none(std::nullopt, process);
  return end_of(process, "a copy of this process", none);
}

fs::path program_beside(const std::string& name) {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / name;
  if (!fs::exists(program)) throw IoError(program.string() + ": is missing; it is built beside drumlin");
  return program;
}

}  // namespace drumlin
