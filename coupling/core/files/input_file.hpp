#pragma once
// A file that somebody named: regular files only, of a limited size. Every reader of the project opens its
// files here.
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "coupling/core/files/descriptor.hpp"

namespace drumlin {

/// Largest sizes, in bytes (docs/robustness.md). A drum of 100,000 grains leaves snapshots of 20 MB and logs
/// of 100 MB.
inline constexpr std::uint64_t largest_text_file = std::uint64_t{1} << 30;
/// 4 GiB, or half of the memory of the machine where that is more: our own files are read as a whole.
std::uint64_t largest_binary_file();

/// A regular file open for reading.
class InputFile {
 public:
  /// Throws InputError (file, what it is, what is allowed) if the file is missing, no regular file or larger
  /// than `largest` bytes; IoError if it cannot be opened.
  InputFile(const std::filesystem::path& file, std::uint64_t largest);

  std::uint64_t size() const { return size_; }  ///< when it was opened, in bytes
  /// Fills `bytes` as far as the file goes; returns how many that were, 0 at its end. Throws IoError.
  std::size_t read(std::span<char> bytes);

 private:
  std::filesystem::path file_;
  Descriptor opened_;
  std::uint64_t size_ = 0;
};

/// What lies under a name that somebody gave: not_found if nothing does. Throws InputError on names that
/// nothing can have (too long, links that lead back to themselves), and IoError.
std::filesystem::file_status input_status(const std::filesystem::path& file);

/// All bytes of a file. Throws as InputFile.
std::string input_bytes(const std::filesystem::path& file, std::uint64_t largest);

/// The text of a file, without the byte order mark that some editors put before UTF-8. Throws as InputFile,
/// and InputError on UTF-16 and UTF-32.
std::string input_text(const std::filesystem::path& file, std::uint64_t largest = largest_text_file);

/// Cuts a byte order mark of UTF-8 off a text; throws InputError naming `file` on those of UTF-16 and UTF-32.
void cut_byte_order_mark(std::string& text, const std::filesystem::path& file);

}  // namespace drumlin
