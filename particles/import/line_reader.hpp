#pragma once
// A text file line by line, numbered for messages. Dumps are too large to be held whole.
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace drumlin::particles {

class LineReader {
 public:
  /// Throws InputError if the file is missing or a folder, IoError if it cannot be read.
  explicit LineReader(const std::filesystem::path& file);
  /// Goes on to the next line, white space at its ends cut off; false at the end.
  bool next();
  const std::string& line() const { return line_; }
  int number() const { return number_; }
  std::string file() const { return file_.string(); }
  [[noreturn]] void refuse(const std::string& key, const std::string& what,
                           const std::string& allowed = "") const;
  /// A finite number. Throws InputError with the place.
  double number_from(std::string_view text, const std::string& key) const;

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  std::string line_;
  int number_ = 0;
};

/// Words between spaces.
std::vector<std::string_view> words_of(std::string_view line);

}  // namespace drumlin::particles
