#include "coupling/core/files/input_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what,
                         const std::string& allowed = "") {
  throw InputError({InputProblem{file.string(), 0, 0, "", what, allowed}});
}

/// What open() leaves to say of a name that it did not open.
[[noreturn]] void say_why_not_open(const std::filesystem::path& file) {
  if (errno == ENOENT || errno == ENOTDIR) refuse(file, "does not exist");
  if (errno == ELOOP) refuse(file, "is a link that leads back to itself");
  if (errno == ENAMETOOLONG) refuse(file, "has too long a name");
  throw_io_error(file, "read");
}

std::string size_text(std::uint64_t bytes) {
  return bytes >= std::uint64_t{1} << 30 ? fmt::format("{:g} GiB", static_cast<double>(bytes) / (1 << 30))
                                         : fmt::format("{:g} MiB", static_cast<double>(bytes) / (1 << 20));
}

}  // namespace

// Without O_NONBLOCK the open itself would wait for somebody who writes into a FIFO.
InputFile::InputFile(const std::filesystem::path& file, std::uint64_t largest)
    : file_(file), opened_(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {
  if (opened_.number() < 0) say_why_not_open(file);
  struct stat status {};
  if (::fstat(opened_.number(), &status) != 0) throw_io_error(file, "read");
  size_ = static_cast<std::uint64_t>(std::max<off_t>(0, status.st_size));
  if (S_ISDIR(status.st_mode)) refuse(file, "is a folder, not a file");
  if (!S_ISREG(status.st_mode)) refuse(file, "is no regular file");
  if (size_ > largest) refuse(file, "is too large", "at most " + size_text(largest));
}

std::size_t InputFile::read(std::span<char> bytes) {
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = ::read(opened_.number(), bytes.data() + filled, bytes.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw_io_error(file_, "read");
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  return filled;
}

std::filesystem::file_status input_status(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() != std::filesystem::file_type::none) return status;
  errno = error.value();
  say_why_not_open(file);
}

std::uint64_t largest_binary_file() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGE_SIZE);
  const auto memory =
      pages > 0 && page > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page) : 0;
  return std::max(std::uint64_t{4} << 30, memory / 2);
}

std::string input_bytes(const std::filesystem::path& file, std::uint64_t largest) {
  InputFile input(file, largest);
  // As large as it was when it was opened: what another program adds meanwhile is not waited for.
  std::string bytes(input.size(), '\0');
  bytes.resize(input.read(bytes));
  return bytes;
}

void cut_byte_order_mark(std::string& text, const std::filesystem::path& file) {
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") ||
      text.starts_with(std::string_view("\0\0\xFE\xFF", 4)))
    refuse(file, "is text in UTF-16 or UTF-32", "UTF-8");
}

std::string input_text(const std::filesystem::path& file, std::uint64_t largest) {
  std::string text = input_bytes(file, largest);
  cut_byte_order_mark(text, file);
  return text;
}

}  // namespace drumlin
