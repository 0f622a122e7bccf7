#pragma once
// Checksums of files: SHA-256, as the program sha256sum writes it. OpenSSL is seen in checksum.cpp alone.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace drumlin {

/// The checksum of bytes that come piece by piece.
class Checksum {
 public:
  Checksum();
  void add(std::string_view bytes);
  /// Of all bytes so far, as 64 hexadecimal digits; more may follow.
  std::string text() const;

 private:
  struct Context;
  std::unique_ptr<Context, void (*)(Context*)> context_;
};

/// The same of a text.
std::string text_sum(std::string_view text);
/// Of the first bytes of a file, to be gone on with; of all, if it has fewer. Throws as file_sum().
Checksum checksum_of(const std::filesystem::path& file, std::uint64_t first_bytes);

/// What a file is known by.
struct FileSum {
  std::uint64_t bytes = 0;
  std::string checksum;
  bool operator==(const FileSum&) const = default;
};

/// Of the whole file, or of its first bytes (of all, if it has fewer). Throws InputError if it is no regular
/// file (a symbolic link is none), IoError if it cannot be read.
FileSum file_sum(const std::filesystem::path& file, std::optional<std::uint64_t> first_bytes = std::nullopt);

}  // namespace drumlin
