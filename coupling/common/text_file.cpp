#include "coupling/common/text_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "coupling/common/errors.hpp"
#include "coupling/common/unfinished_file.hpp"

namespace drumlin {

std::string file_text(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw InputError(file.string() + ": no such file");
  if (std::filesystem::is_directory(status)) throw InputError(file.string() + ": is a folder, not a file");
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  // An empty file sets the failbit of `content` and is no fault here.
  if (stream.good() && stream.peek() != std::ifstream::traits_type::eof()) content << stream.rdbuf();
  if (!stream.is_open() || stream.bad()) throw IoError(file.string() + ": cannot be read");
  return content.str();
}

namespace {

[[noreturn]] void give_up(const std::filesystem::path& file, int descriptor) {
  const std::string reason = std::strerror(errno);
  if (descriptor >= 0) ::close(descriptor);
  throw IoError(file.string() + ": cannot be written: " + reason);
}

}  // namespace

void replace_file(const std::filesystem::path& file, const std::string& text) {
  const UnfinishedFile unfinished(file.string() + ".part");
  const std::filesystem::path& aside = unfinished.path();
  const int descriptor = ::open(aside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) give_up(file, descriptor);
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t bytes = ::write(descriptor, text.data() + written, text.size() - written);
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) give_up(file, descriptor);
    written += static_cast<std::size_t>(bytes);
  }
  // Some file systems report a full disk only here.
  if (::fsync(descriptor) != 0) give_up(file, descriptor);
  if (::close(descriptor) != 0) give_up(file, -1);
  if (::rename(aside.c_str(), file.c_str()) != 0) give_up(file, -1);
}

}  // namespace drumlin
