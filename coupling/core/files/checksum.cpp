#include "coupling/core/files/checksum.hpp"

// OpenSSL's older functions need neither memory nor its settings; the newer ones crash where memory is short.
#define OPENSSL_SUPPRESS_DEPRECATED
#include <fmt/format.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {

struct Checksum::Context {
  SHA256_CTX digest{};
};

// These functions always succeed.
Checksum::Checksum() : context_(new Context, [](Context* context) { delete context; }) {
  SHA256_Init(&context_->digest);
}

void Checksum::add(std::string_view bytes) { SHA256_Update(&context_->digest, bytes.data(), bytes.size()); }

std::string Checksum::text() const {
  SHA256_CTX so_far = context_->digest;
  std::array<unsigned char, SHA256_DIGEST_LENGTH> bytes{};
  SHA256_Final(bytes.data(), &so_far);
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

namespace {

/// Adds the first bytes of a file; returns how many there were.
std::uint64_t add_file(const std::filesystem::path& file, std::uint64_t first_bytes, Checksum& sum) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, error)))
    throw InputError(file.string() + ": is missing, or no regular file");
  std::ifstream stream(file, std::ios::binary);
  std::uint64_t left = first_bytes, count = 0;
  std::string piece(1 << 18, '\0');
  while (left > 0 && stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(left, piece.size())));
    const auto read = static_cast<std::uint64_t>(stream.gcount());
    sum.add({piece.data(), static_cast<std::size_t>(read)});
    count += read, left -= read;
  }
  if (!stream.is_open() || stream.bad()) throw IoError(file.string() + ": cannot be read");
  return count;
}

}  // namespace

Checksum checksum_of(const std::filesystem::path& file, std::uint64_t first_bytes) {
  Checksum sum;
  add_file(file, first_bytes, sum);
  return sum;
}

std::string text_sum(std::string_view text) {
  Checksum sum;
  sum.add(text);
  return sum.text();
}

FileSum file_sum(const std::filesystem::path& file, std::optional<std::uint64_t> first_bytes) {
  Checksum sum;
  const std::uint64_t bytes =
      add_file(file, first_bytes.value_or(std::numeric_limits<std::uint64_t>::max()), sum);
  return {bytes, sum.text()};
}

}  // namespace drumlin
