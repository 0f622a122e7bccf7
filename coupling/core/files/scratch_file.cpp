#include "coupling/core/files/scratch_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {
namespace {

[[noreturn]] void give_up(const std::filesystem::path& folder, const char* what) {
  throw IoError(folder.string() + ": a file for what does not fit into memory cannot be " + what + ": " +
                std::strerror(errno));
}

Descriptor open_nameless(const std::filesystem::path& folder) {
  Descriptor file(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  if (file.number() >= 0) return file;
  // Not every file system has files without a name: one that loses its name at once.
  std::string name = folder / ".drumlin-scratch-XXXXXX";  // mkostemp() puts letters in place of the X
  file = Descriptor(::mkostemp(name.data(), O_CLOEXEC));
  if (file.number() < 0) give_up(folder, "made");
  ::unlink(name.c_str());
  return file;
}

}  // namespace

std::uint64_t ScratchFile::append(std::span<const std::byte> bytes) {
  if (file_.number() < 0) file_ = open_nameless(folder_);
  if (!file_.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()})) give_up(folder_, "written");
  return std::exchange(size_, size_ + bytes.size());
}

void ScratchFile::read(std::uint64_t place, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(file_.number(), bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) give_up(folder_, "read");
    place += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

}  // namespace drumlin
