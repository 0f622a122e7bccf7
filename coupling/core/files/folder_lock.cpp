#include "coupling/core/files/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <ctime>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {

namespace fs = std::filesystem;

namespace {

/// Whether the open file is still the one of that name: its holder removes it in the end.
bool is_there(int descriptor, const fs::path& file) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(descriptor, &opened) == 0 && ::lstat(file.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

std::string holder_in(int descriptor) {
  std::array<char, 512> text{};
  const ssize_t bytes = ::pread(descriptor, text.data(), text.size(), 0);
  return bytes > 0 ? std::string(text.data(), static_cast<std::size_t>(bytes)) : "another process";
}

}  // namespace

std::string time_text() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &parts);
  return text.data();
}

FolderLock::FolderLock(const fs::path& file, const std::string& command) : held_(-1) {
  do {  // its holder may remove it after we have opened it
    held_ = Descriptor(::open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666));
    if (held_.number() < 0) throw_io_error(file, "made");
    if (::flock(held_.number(), LOCK_EX | LOCK_NB) == 0) continue;
    if (errno != EWOULDBLOCK) throw_io_error(file, "locked");
    throw InputError(fmt::format("{}: is being written by {}; wait until it has ended",
                                 file.has_parent_path() ? file.parent_path().string() : ".",
                                 holder_in(held_.number())));
  } while (!is_there(held_.number(), file));
  named_ = std::make_unique<UnfinishedFile>(file);
  if (::ftruncate(held_.number(), 0) != 0 ||
      !held_.write(fmt::format("process {}, {}, since {}", ::getpid(), command, time_text())))
    throw_io_error(file, "written");
}

}  // namespace drumlin
