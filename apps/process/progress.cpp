#include "apps/process/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "apps/process/standard_streams.hpp"

namespace drumlin::apps {
namespace {
bool on_terminal() { return ::isatty(STDERR_FILENO) != 0; }
}  // namespace

bool Progress::due() const {
  const bool often = on_terminal() || std::getenv("DRUMLIN_PROGRESS") != nullptr;
  return std::chrono::steady_clock::now() - last_ >= std::chrono::milliseconds(often ? 500 : 15000);
}

void Progress::show(const std::string& line) {
  last_ = std::chrono::steady_clock::now();
  open_ = on_terminal();
  if (open_)
    print_over_line(fmt::format("{:<{}}", line, width_));
  else
    print_error(fmt::format("{}\n", line));
  width_ = line.size();
}

void Progress::finish() {
  if (open_) print_error("\n");
  open_ = false;
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

}  // namespace drumlin::apps
