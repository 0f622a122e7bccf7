// A library for LD_PRELOAD that records what a program asks of the file system, so that a test can lay out
// what a disk may hold after a power cut.
//
// FILE_CALLS_TO=FILE in the environment receives a line for each call that has succeeded, paths absolute, no
// blanks in them; INODE is a number of a file or folder that does not change when it is renamed:
//   create INODE PATH          a new, empty file
//   mkdir INODE PATH           a new folder
//   write INODE OFFSET BYTES   BYTES in hexadecimal digits
//   truncate INODE SIZE
//   sync INODE                 fsync of a file or of a folder
//   rename FROM TO
//   remove PATH                of a file or of an empty folder
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <climits>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>

namespace {

std::recursive_mutex one_at_a_time;

/// The function of that name that the program would have called.
template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

void record(const std::string& line) {
  static std::FILE* const out = [] {
    const char* const file = std::getenv("FILE_CALLS_TO");
    return file != nullptr ? std::fopen(file, "ae") : nullptr;
  }();
  if (out == nullptr) return;
  std::fputs((line + "\n").c_str(), out);
  std::fflush(out);
}

std::string absolute(int folder, const char* path) {
  if (path[0] == '/') return path;
  char base[PATH_MAX] = "";
  const std::string link = folder == AT_FDCWD ? "/proc/self/cwd" : "/proc/self/fd/" + std::to_string(folder);
  const ssize_t length = ::readlink(link.c_str(), base, sizeof base - 1);
  return std::string(base, length > 0 ? static_cast<std::size_t>(length) : 0) + "/" + path;
}

bool is_there(int folder, const char* path) {
  struct stat found {};
  return ::fstatat(folder, path, &found, AT_SYMLINK_NOFOLLOW) == 0;
}

/// Of an open regular file or folder; empty for all else.
std::string inode_of(int file) {
  struct stat found {};
  const bool counts = ::fstat(file, &found) == 0 && (S_ISREG(found.st_mode) || S_ISDIR(found.st_mode));
  return counts ? std::to_string(found.st_ino) : "";
}

std::string inode_of(int folder, const char* path) {
  struct stat found {};
  ::fstatat(folder, path, &found, AT_SYMLINK_NOFOLLOW);
  return std::to_string(found.st_ino);
}

ssize_t written(int file, const void* bytes, ssize_t count, off_t offset) {
  if (count <= 0 || inode_of(file).empty()) return count;
  std::string line = "write " + inode_of(file) + " " + std::to_string(offset) + " ";
  const auto* const byte = static_cast<const unsigned char*>(bytes);
  for (ssize_t k = 0; k < count; ++k) {
    line += "0123456789abcdef"[byte[k] / 16];
    line += "0123456789abcdef"[byte[k] % 16];
  }
  record(line);
  return count;
}

int synced(int file, int result) {
  if (result == 0 && !inode_of(file).empty()) record("sync " + inode_of(file));
  return result;
}

}  // namespace

extern "C" {

// The mode that a call without it does not hand over is not looked at. Names with 64 are the same calls.
int open_at(int folder, const char* path, int flags, mode_t mode) asm("openat");
int open_at(int folder, const char* path, int flags, mode_t mode) {
  const std::scoped_lock lock(one_at_a_time);
  const bool creates = (flags & O_CREAT) != 0 && !is_there(folder, path);
  const int file = real<int(int, const char*, int, ...)>("openat")(folder, path, flags, mode);
  if (file < 0) return file;
  if (creates) record("create " + inode_of(file) + " " + absolute(folder, path));
  if (!creates && (flags & O_TRUNC) != 0 && !inode_of(file).empty())
    record("truncate " + inode_of(file) + " 0");
  return file;
}
int open64_at(int folder, const char* path, int flags, mode_t mode) asm("openat64")
    __attribute__((alias("openat")));
int open_here(const char* path, int flags, mode_t mode) asm("open");
int open_here(const char* path, int flags, mode_t mode) { return open_at(AT_FDCWD, path, flags, mode); }
int open64_here(const char* path, int flags, mode_t mode) asm("open64") __attribute__((alias("open")));

ssize_t write(int file, const void* bytes, size_t count) {
  const std::scoped_lock lock(one_at_a_time);
  const ssize_t done = real<ssize_t(int, const void*, size_t)>("write")(file, bytes, count);
  return written(file, bytes, done, ::lseek(file, 0, SEEK_CUR) - done);
}
ssize_t pwrite(int file, const void* bytes, size_t count, off_t offset) {
  const std::scoped_lock lock(one_at_a_time);
  const auto done = real<ssize_t(int, const void*, size_t, off_t)>("pwrite")(file, bytes, count, offset);
  return written(file, bytes, done, offset);
}
ssize_t pwrite64(int, const void*, size_t, off64_t) __attribute__((alias("pwrite")));

int ftruncate(int file, off_t size) noexcept {
  const std::scoped_lock lock(one_at_a_time);
  const int result = real<int(int, off_t)>("ftruncate")(file, size);
  if (result == 0) record("truncate " + inode_of(file) + " " + std::to_string(size));
  return result;
}
int ftruncate64(int, off64_t) noexcept __attribute__((alias("ftruncate")));

int fsync(int file) {
  const std::scoped_lock lock(one_at_a_time);
  return synced(file, real<int(int)>("fsync")(file));
}
int fdatasync(int) __attribute__((alias("fsync")));

int mkdir(const char* path, mode_t mode) noexcept {
  const std::scoped_lock lock(one_at_a_time);
  const int result = real<int(const char*, mode_t)>("mkdir")(path, mode);
  if (result == 0) record("mkdir " + inode_of(AT_FDCWD, path) + " " + absolute(AT_FDCWD, path));
  return result;
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  const std::scoped_lock lock(one_at_a_time);
  const int result =
      real<int(int, const char*, int, const char*)>("renameat")(from_folder, from, to_folder, to);
  if (result == 0) record("rename " + absolute(from_folder, from) + " " + absolute(to_folder, to));
  return result;
}
int rename(const char* from, const char* to) noexcept { return renameat(AT_FDCWD, from, AT_FDCWD, to); }

int unlinkat(int folder, const char* path, int flags) noexcept {
  const std::scoped_lock lock(one_at_a_time);
  const int result = real<int(int, const char*, int)>("unlinkat")(folder, path, flags);
  if (result == 0) record("remove " + absolute(folder, path));
  return result;
}
int unlink(const char* path) noexcept { return unlinkat(AT_FDCWD, path, 0); }
int rmdir(const char* path) noexcept { return unlinkat(AT_FDCWD, path, AT_REMOVEDIR); }
int remove(const char* path) noexcept {
  struct stat found {};
  const bool is_folder = ::lstat(path, &found) == 0 && S_ISDIR(found.st_mode);
  return is_folder ? rmdir(path) : unlink(path);
}
}
