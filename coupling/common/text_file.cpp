#include "coupling/common/text_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "coupling/common/errors.hpp"
#include "coupling/common/input_file.hpp"

namespace drumlin {

std::string file_text(const std::filesystem::path& file) { return input_bytes(file, largest_text_file); }

namespace {

[[noreturn]] void give_up(const std::filesystem::path& aside, const std::filesystem::path& file,
                          int descriptor) {
  const std::string reason = std::strerror(errno);
  if (descriptor >= 0) ::close(descriptor);
  ::unlink(aside.c_str());
  throw IoError(file.string() + ": cannot be written: " + reason);
}

}  // namespace

void replace_file(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path aside = file.string() + ".part";
  const int descriptor = ::open(aside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) give_up(aside, file, descriptor);
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t bytes = ::write(descriptor, text.data() + written, text.size() - written);
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) give_up(aside, file, descriptor);
    written += static_cast<std::size_t>(bytes);
  }
  // Some file systems report a full disk only here.
  if (::fsync(descriptor) != 0) give_up(aside, file, descriptor);
  if (::close(descriptor) != 0) give_up(aside, file, -1);
  if (::rename(aside.c_str(), file.c_str()) != 0) give_up(aside, file, -1);
}

}  // namespace drumlin
