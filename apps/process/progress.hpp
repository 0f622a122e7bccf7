#pragma once
// One line of progress on standard error: rewritten in place on a terminal, now and then in a file.
#include <chrono>
#include <string>

namespace drumlin::apps {

class Progress {
 public:
  /// Whether it is time for a new line: twice a second on a terminal, or where DRUMLIN_PROGRESS is set (the
  /// Python package reads it), every 15 s elsewhere.
  bool due() const;
  void show(const std::string& line);
  /// Ends a line that was rewritten in place.
  void finish();

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now() - std::chrono::hours(1);
  std::size_t width_ = 0;
  bool open_ = false;
};

/// "1 h 02 min", "3 min 05 s", "12 s".
std::string duration_text(double seconds);

}  // namespace drumlin::apps
