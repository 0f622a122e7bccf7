#include "coupling/common/machine/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
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
#include "coupling/common/files/input_file.hpp"

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
constexpr std::array passed_on{SIGINT, SIGTERM, SIGHUP};
std::array<struct sigaction, passed_on.size()> before{};

extern "C" void pass_on(int signal) {
  if (child > 0)
    ::kill(child, signal);
  else
    waiting = signal;
  for (std::size_t s = 0; s < passed_on.size(); ++s)
    if (passed_on[s] == signal && before[s].sa_handler != SIG_DFL) before[s].sa_handler(signal);
}

/// Passes signals on to a process while it lives; from before it is started, so that none is lost.
class PassingOn {
 public:
  PassingOn() {
    child = 0;
    waiting = 0;
    struct sigaction action {};
    action.sa_handler = pass_on;
    action.sa_flags = SA_RESTART;
    for (std::size_t s = 0; s < passed_on.size(); ++s) {
      ::sigaction(passed_on[s], nullptr, &before[s]);
      if (before[s].sa_handler != SIG_IGN) ::sigaction(passed_on[s], &action, nullptr);
    }
  }
  ~PassingOn() {
    for (std::size_t s = 0; s < passed_on.size(); ++s) ::sigaction(passed_on[s], &before[s], nullptr);
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

/// Keeps signals from this thread while it lives: between fork and exec the child still has our handlers.
class SignalsHeld {
 public:
  SignalsHeld() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsHeld() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;
  const sigset_t& before() const { return before_; }

 private:
  sigset_t before_{};
};

/// What a child needs to become another program, made before the fork: between fork and exec nothing may be
/// allocated.
struct Start {
  const char* program = nullptr;
  char* const* words = nullptr;
  char* const* environment = nullptr;
  int input = -1;
  ProcessOutput output = ProcessOutput::inherited;
  int captured = -1;   // where captured output goes
  int failed = -1;     // takes errno if there is no such program
  int end_signal = 0;  // that comes when the parent ends
  pid_t parent = 0;
  const sigset_t* mask = nullptr;
};

[[noreturn]] void become(const Start& start) {
  ::prctl(PR_SET_PDEATHSIG, start.end_signal);
  if (::getppid() != start.parent) ::_exit(128 + SIGKILL);  // it ended before it could be watched
  if (start.input >= 0) ::dup2(start.input, STDIN_FILENO);
  if (start.output != ProcessOutput::inherited) ::dup2(start.captured, STDOUT_FILENO);
  if (start.output == ProcessOutput::with_errors) ::dup2(start.captured, STDERR_FILENO);
  for (const int signal : passed_on) {
    struct sigaction action {};
    ::sigaction(signal, nullptr, &action);
    if (action.sa_handler != SIG_IGN) std::signal(signal, SIG_DFL);
  }
  std::signal(SIGPIPE, SIG_DFL);
  ::pthread_sigmask(SIG_SETMASK, start.mask, nullptr);
  ::execvpe(start.program, start.words, start.environment);
  const int error = errno;
  (void)!::write(start.failed, &error, sizeof error);
  ::_exit(127);
}

pid_t started(const ProcessRequest& request, const Pipe& output) {
  std::vector<std::string> words = {request.program.string()};
  words.insert(words.end(), request.words.begin(), request.words.end());
  std::vector<std::string> variables = environment_with(request.environment);
  const std::vector<char*> word_pointers = pointers(words), variable_pointers = pointers(variables);
  Pipe failed(request.program);
  const SignalsHeld held;
  const Start start{.program = request.program.c_str(),
                    .words = word_pointers.data(),
                    .environment = variable_pointers.data(),
                    .input = request.input,
                    .output = request.output,
                    .captured = output.write_end(),
                    .failed = failed.write_end(),
                    .end_signal = request.end_signal,
                    .parent = ::getpid(),
                    .mask = &held.before()};
  const pid_t process = ::fork();
  if (process < 0) fail(request.program, errno);
  if (process == 0) become(start);
  failed.close_write_end();
  int error = 0;
  if (::read(failed.read_end(), &error, sizeof error) == static_cast<ssize_t>(sizeof error)) {
    ::waitpid(process, nullptr, 0);
    fail(request.program, error);
  }
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

void require_loaded(const ProcessEnd& end, const std::string& name) {
  if (end.exit_code == 127) throw IoError(name + ": could not be loaded, for lack of memory or of a library");
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
  if (!fs::exists(program))
    throw IoError(program.string() +
                  ": is missing; the target programs builds it, unless DRUMLIN_CONTINUUM is OFF");
  refuse_special(".adolcrc");  // ADOL-C, within deal.II, reads it as it is loaded, and would wait for a FIFO
  return program;
}

}  // namespace drumlin
