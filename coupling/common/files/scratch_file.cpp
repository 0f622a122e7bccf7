#include "coupling/common/files/scratch_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "coupling/common/errors.hpp"

namespace drumlin {
namespace {

[[noreturn]] void give_up(const std::filesystem::path& folder, const char* what) {
  throw IoError(folder.string() + ": a file for what does not fit into memory cannot be " + what + ": " +
                std::strerror(errno));
}

int open_nameless(const std::filesystem::path& folder) {
  int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor >= 0) return descriptor;
  // Not every file system has files without a name: one that loses its name at once.
  std::string name = folder / ".drumlin-scratch-XXXXXX";
  descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) give_up(folder, "made");
  ::unlink(name.c_str());
  return descriptor;
}

}  // namespace

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ScratchFile::write_out() {
  if (descriptor_ < 0) descriptor_ = open_nameless(folder_);
  std::span<const std::byte> left = newest_;
  while (!left.empty()) {
    const ssize_t bytes = ::pwrite(descriptor_, left.data(), left.size(), static_cast<off_t>(on_disk_));
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) give_up(folder_, "written");
    left = left.subspan(static_cast<std::size_t>(bytes));
    on_disk_ += static_cast<std::uint64_t>(bytes);
  }
  newest_.clear();
}

std::uint64_t ScratchFile::append(std::span<const std::byte> bytes) {
  const std::uint64_t place = size();
  while (!bytes.empty()) {
    const std::size_t fits = std::min(bytes.size(), in_memory - newest_.size());
    if (newest_.size() + fits > newest_.capacity())
      newest_.reserve(std::min(in_memory, 2 * (newest_.size() + fits)));
    newest_.insert(newest_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(fits));
    bytes = bytes.subspan(fits);
    if (newest_.size() == in_memory) write_out();
  }
  return place;
}

void ScratchFile::read(std::uint64_t place, std::span<std::byte> bytes) const {
  assert(place + bytes.size() <= size());
  while (!bytes.empty() && place < on_disk_) {
    const std::size_t most = std::min<std::uint64_t>(bytes.size(), on_disk_ - place);
    const ssize_t got = ::pread(descriptor_, bytes.data(), most, static_cast<off_t>(place));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) give_up(folder_, "read");
    place += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
  if (bytes.empty()) return;
  std::memcpy(bytes.data(), newest_.data() + (place - on_disk_), bytes.size());
}

}  // namespace drumlin
