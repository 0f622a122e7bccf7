#pragma once
// What the targets share: a reader reads or refuses, and anything else is a finding.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "coupling/common/errors.hpp"

namespace drumlin::fuzz {

/// Runs a reader. Only InputError may leave it, with a text that says why; whatever else does ends the
/// program.
template <class Read>
int read_or_refused(Read read) {
  try {
    read();
  } catch (const InputError& refused) {
    if (*refused.what() == '\0') std::abort();
  }
  return 0;
}

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A folder that goes with the program. Like TemporaryFolder of tests/exchange_files, whose header needs
/// GoogleTest; a target under libFuzzer is linked without it.
class ScratchFolder {
 public:
  ScratchFolder() {
    // mkdtemp() asks for the six X and replaces them.
    std::string pattern = (std::filesystem::temp_directory_path() / "drumlin-fuzz-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path with(const std::string& name, std::string_view text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace drumlin::fuzz
