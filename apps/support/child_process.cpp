#include "apps/support/child_process.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "coupling/exchange/errors.hpp"

extern char** environ;

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& program, int error) {
  throw IoError(fmt::format("{}: {}", program.string(), std::strerror(error)));
}

// The end of a pipe, closed with the scope.
struct ReadEnd {
  explicit ReadEnd(int of) : file(of) {}
  ~ReadEnd() { ::close(file); }
  ReadEnd(const ReadEnd&) = delete;
  ReadEnd& operator=(const ReadEnd&) = delete;
  int file;
};

pid_t started(const fs::path& program, const std::vector<std::string>& words,
              const std::array<int, 2>& pipe) {
  std::vector<std::string> all = {program.string()};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  for (std::string& word : all) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_addclose(&actions, pipe[0]);
  ::posix_spawn_file_actions_addclose(&actions, pipe[1]);
  pid_t process = 0;
  const int error = ::posix_spawn(&process, program.c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(pipe[1]);
  if (error != 0) {
    ::close(pipe[0]);
    fail(program, error);
  }
  return process;
}

}  // namespace

fs::path program_beside(const std::string& name) {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / name;
  if (!fs::exists(program)) throw IoError(program.string() + ": is missing; it is built beside drumlin");
  return program;
}

int run_for_lines(const fs::path& program, const std::vector<std::string>& words,
                  const std::function<void(const std::string&)>& line) {
  std::array<int, 2> pipe{};
  if (::pipe(pipe.data()) != 0) fail(program, errno);
  const pid_t process = started(program, words, pipe);
  {
    const ReadEnd output(pipe[0]);
    std::string text;
    std::array<char, 4096> buffer{};
    for (;;) {
      const ssize_t count = ::read(output.file, buffer.data(), buffer.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) break;
      text.append(buffer.data(), static_cast<std::size_t>(count));
      for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1))
        line(text.substr(0, end));
    }
    if (!text.empty()) line(text);
  }
  int status = 0;
  while (::waitpid(process, &status, 0) < 0)
    if (errno != EINTR) fail(program, errno);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace drumlin::apps
