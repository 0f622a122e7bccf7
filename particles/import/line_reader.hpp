#pragma once
// A text file line by line, numbered for messages. Dumps are too large to be held whole.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "coupling/core/files/input_file.hpp"

namespace drumlin::particles {

class LineReader {
 public:
  /// Of any size. Throws InputError if the file is missing, no regular file or compressed, IoError if it
  /// cannot be read.
  explicit LineReader(const std::filesystem::path& file);
  /// Goes on to the next line, white space at its ends cut off; false at the end. Throws InputError on a line
  /// of more than 1 MiB.
  bool next();
  const std::string& line() const { return line_; }
  int number() const { return number_; }
  /// Whether the last line lacks its end, as a file has it whose program was killed.
  bool unended() const { return unended_; }
  std::string file() const { return file_.string(); }
  [[noreturn]] void refuse(const std::string& key, const std::string& what,
                           const std::string& allowed = "") const;
  /// A finite number. Throws InputError with the place.
  double number_from(std::string_view text, const std::string& key) const;

 private:
  bool fill();

  std::filesystem::path file_;
  InputFile input_;
  std::string buffer_;  ///< what was read; lines are taken from `taken_` on
  std::size_t taken_ = 0;
  std::string line_;
  int number_ = 0;
  bool unended_ = false;
};

/// Words between spaces.
std::vector<std::string_view> words_of(std::string_view line);

}  // namespace drumlin::particles
