#include "apps/support/figures.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "coupling/exchange/errors.hpp"

extern char** environ;

namespace drumlin::apps {

namespace {

/// The environment of this process with matplotlib's settings in place of its own.
std::vector<std::string> figure_environment() {
  // Agg draws without a display; threads in OpenBLAS cost more than they bring to a figure.
  const std::vector<std::string> settings{"MPLBACKEND=Agg", "OPENBLAS_NUM_THREADS=1", "OMP_NUM_THREADS=1",
                                          "PYTHONDONTWRITEBYTECODE=1"};
  std::vector<std::string> result = settings;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    bool replaced = false;
    for (const auto& setting : settings)
      replaced |= text.starts_with(setting.substr(0, setting.find('=') + 1));
    if (!replaced) result.emplace_back(text);
  }
  return result;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (auto& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

std::string everything_from(int descriptor) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t bytes = ::read(descriptor, buffer.data(), buffer.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(bytes));
  }
}

}  // namespace

void draw_figures(const std::string& script, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{DRUMLIN_PYTHON, (std::filesystem::path(DRUMLIN_FIGURES) / script).string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = figure_environment();

  std::array<int, 2> messages{};
  if (::pipe2(messages.data(), O_CLOEXEC) != 0)
    throw IoError(fmt::format("{}: no pipe: {}", script, std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  // Standard output stays free for the command's own results (--json).
  posix_spawn_file_actions_adddup2(&actions, messages[1], STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&actions, messages[1], STDOUT_FILENO);
  pid_t child = 0;
  const int failure = posix_spawn(&child, DRUMLIN_PYTHON, &actions, nullptr, pointers(words).data(),
                                  pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  ::close(messages[1]);
  if (failure != 0) {
    ::close(messages[0]);
    throw IoError(fmt::format("{}: cannot be started: {}", DRUMLIN_PYTHON, std::strerror(failure)));
  }
  const std::string said = everything_from(messages[0]);
  ::close(messages[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw IoError(fmt::format("the figures of {} were not drawn:\n{}", script, said));
}

}  // namespace drumlin::apps
