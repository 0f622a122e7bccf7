#include "coupling/common/checksum.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>

#include "coupling/common/errors.hpp"

namespace drumlin {

struct Checksum::Context {
  Context() : digest(EVP_MD_CTX_new(), EVP_MD_CTX_free) {}
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> digest;
};

namespace {

void require(int done) {
  if (done != 1) throw IoError("OpenSSL cannot compute SHA-256");
}

}  // namespace

Checksum::Checksum() : context_(std::make_unique<Context>()) {
  require(EVP_DigestInit_ex(context_->digest.get(), EVP_sha256(), nullptr));
}
Checksum::~Checksum() = default;
Checksum::Checksum(Checksum&&) noexcept = default;
Checksum& Checksum::operator=(Checksum&&) noexcept = default;

void Checksum::add(std::string_view bytes) {
  require(EVP_DigestUpdate(context_->digest.get(), bytes.data(), bytes.size()));
}

std::string Checksum::text() const {
  const Context so_far;
  require(EVP_MD_CTX_copy_ex(so_far.digest.get(), context_->digest.get()));
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned int size = 0;
  require(EVP_DigestFinal_ex(so_far.digest.get(), bytes.data(), &size));
  std::string text;
  for (unsigned int i = 0; i < size; ++i)
    text += {"0123456789abcdef"[bytes[i] / 16], "0123456789abcdef"[bytes[i] % 16]};
  return text;
}

FileSum file_sum(const std::filesystem::path& file, std::optional<std::uint64_t> first_bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, error)))
    throw InputError(file.string() + ": is missing, or no regular file");
  std::ifstream stream(file, std::ios::binary);
  Checksum sum;
  std::uint64_t left = first_bytes.value_or(std::numeric_limits<std::uint64_t>::max()), count = 0;
  std::string piece(1 << 18, '\0');
  while (left > 0 && stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(left, piece.size())));
    const auto read = static_cast<std::uint64_t>(stream.gcount());
    sum.add({piece.data(), static_cast<std::size_t>(read)});
    count += read, left -= read;
  }
  if (!stream.is_open() || stream.bad()) throw IoError(file.string() + ": cannot be read");
  return {count, sum.text()};
}

}  // namespace drumlin
