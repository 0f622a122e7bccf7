#include "apps/process/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>

#include "coupling/common/errors.hpp"

namespace drumlin::apps {
namespace {
int lost = 0;  // errno of the first write that failed; like the stream it belongs to the process

int error_number() { return errno != 0 ? errno : EIO; }

/// Bytes of the character at the beginning of a text that a terminal takes for no order; 0: it is a control
/// character (of ASCII or of Latin 1), changes the direction of writing, or is no UTF-8.
std::size_t harmless_bytes(std::string_view text) noexcept {
  const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  const unsigned first = byte(0);
  if (first < 0x80) return (first >= ' ' && first != 0x7f) || first == '\n' || first == '\t' ? 1 : 0;
  const std::size_t bytes = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  std::uint32_t letter = first & (0x7fU >> bytes);
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xc0U) != 0x80) return 0;
    letter = letter << 6U | (byte(k) & 0x3fU);
  }
  constexpr std::array<std::uint32_t, 5> least{0, 0, 0xa0, 0x800, 0x10000};
  const auto lies = [&](std::uint32_t from, std::uint32_t to) { return letter >= from && letter <= to; };
  const bool turns = lies(0x202a, 0x202e) || lies(0x2066, 0x2069);
  return first < 0xc0 || first > 0xf4 || letter < least[bytes] || letter > 0x10ffff || lies(0xd800, 0xdfff) ||
                 turns
             ? 0
             : bytes;
}

/// What others have named may hold orders to the terminal: such bytes are written as \xNN. Whether all was
/// written. Allocates nothing.
bool write_harmless(std::string_view text, std::FILE* stream) noexcept {
  while (!text.empty()) {
    std::size_t good = 0;
    while (good < text.size()) {
      const std::size_t bytes = harmless_bytes(text.substr(good));
      if (bytes == 0) break;
      good += bytes;
    }
    if (std::fwrite(text.data(), 1, good, stream) < good) return false;
    text.remove_prefix(good);
    if (text.empty()) return true;
    const auto bad = static_cast<unsigned char>(text.front());
    const std::array<char, 4> shown{'\\', 'x', "0123456789abcdef"[bad / 16], "0123456789abcdef"[bad % 16]};
    if (std::fwrite(shown.data(), 1, shown.size(), stream) < shown.size()) return false;
    text.remove_prefix(1);
  }
  return true;
}
}  // namespace

void open_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // The lowest free descriptor is this one. Standard output is opened for reading: writing to it fails.
    const int mode = descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY;
    if (::open("/dev/null", mode) != descriptor) ::_exit(static_cast<int>(ExitCode::input_output));
  }
}

void print_out(std::string_view text) {
  if (lost != 0) return;
  errno = 0;
  if (!write_harmless(text, stdout)) lost = error_number();
}

void flush_out() {
  if (lost != 0) return;
  errno = 0;
  if (std::fflush(stdout) != 0) lost = error_number();
}

int lost_output() {
  flush_out();
  return lost;
}

void print_error(std::string_view text) noexcept {
  (void)write_harmless(text, stderr);
  (void)std::fflush(stderr);
}

void print_over_line(std::string_view text) noexcept {
  (void)std::fputc('\r', stderr);
  print_error(text);
}

}  // namespace drumlin::apps
