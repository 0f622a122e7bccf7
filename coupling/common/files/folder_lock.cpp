#include "coupling/common/files/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "coupling/common/errors.hpp"

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

FolderLock::FolderLock(fs::path file, const std::string& command) : file_(std::move(file)) {
  if (file_.filename() == folder_lock_name) own_.emplace(file_.parent_path());
  while (!take(command)) {
  }
}

/// False: its holder removed the file after we had opened it.
bool FolderLock::take(const std::string& command) {
  const auto fail = [&](const std::string& what) {
    const std::string reason = std::strerror(errno);
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
    throw IoError(fmt::format("{}: cannot be {}: {}", file_.string(), what, reason));
  };
  const Descriptor above = open_folder(file_.parent_path());
  if (above.number() >= 0)
    descriptor_ = ::openat(above.number(), file_.filename().c_str(),
                           O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("made");
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) fail("locked");
    const std::string holder = holder_in(descriptor_);
    ::close(std::exchange(descriptor_, -1));
    const fs::path folder = file_.has_parent_path() ? file_.parent_path() : fs::path(".");
    throw InputError(
        fmt::format("{}: is being written by {}; wait until it has ended", folder.string(), holder));
  }
  if (!is_there(descriptor_, file_)) {
    ::close(std::exchange(descriptor_, -1));
    return false;
  }
  named_ = std::make_unique<UnfinishedFile>(file_);
  const std::string said = fmt::format("process {}, {}, since {}", ::getpid(), command, time_text());
  if (::ftruncate(descriptor_, 0) != 0 ||
      ::pwrite(descriptor_, said.data(), said.size(), 0) != static_cast<ssize_t>(said.size())) {
    const int error = errno;
    named_.reset();  // while it is held, as below
    errno = error;
    fail("written");
  }
  return true;
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : file_(std::move(other.file_)),
      own_(std::move(other.own_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      named_(std::move(other.named_)) {}

FolderLock::~FolderLock() {
  if (descriptor_ < 0) return;
  // While it is held: whoever has opened it meanwhile sees that it has gone.
  named_.reset();
  ::close(descriptor_);
}

}  // namespace drumlin
