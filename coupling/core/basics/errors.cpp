#include "coupling/core/basics/errors.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace drumlin {

namespace {

std::string joined(const std::vector<InputProblem>& problems) {
  std::string lines;
  for (const auto& problem : problems) {
    if (!lines.empty()) lines += '\n';
    lines += problem.text();
  }
  return lines;
}

}  // namespace

std::string InputProblem::text() const {
  std::string place = file;
  if (line > 0) place += fmt::format(":{}", line);
  if (line > 0 && column > 0) place += fmt::format(":{}", column);
  if (!place.empty()) place += ": ";
  if (!key.empty()) place += key + ": ";
  return place + what + (allowed.empty() ? "" : fmt::format(" (allowed: {})", allowed));
}

InputError::InputError(std::vector<InputProblem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

InputError::InputError(const std::string& message)
    : InputError(std::vector<InputProblem>{{"", 0, 0, "", message, ""}}) {}

void throw_io_error(const std::filesystem::path& file, const std::string& what) {
  throw IoError(fmt::format("{}: cannot be {}: {}", file.string(), what, std::strerror(errno)));
}

}  // namespace drumlin
