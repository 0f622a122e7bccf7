#include "coupling/core/files/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/input_file.hpp"

namespace drumlin {

std::string file_text(const std::filesystem::path& file) { return input_bytes(file, largest_text_file); }

namespace {

namespace fs = std::filesystem;

constexpr std::string_view aside_begin = ".drumlin-", aside_end = ".part";

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : "."; }

/// That no other process, nor an earlier one of this number, has in use.
fs::path name_beside(const fs::path& file) {
  static std::atomic<int> files = 0;
  fs::path name = file.parent_path() / fmt::format("{}{}-{}{}", aside_begin, ::getpid(), ++files, aside_end);
  ::unlink(name.c_str());
  return name;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& file)
    : file_(file),
      unfinished_(name_beside(file)),
      content_(::open(path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
  if (content_.number() < 0) throw_io_error(file_, "written");
}

void AtomicFile::write(std::string_view content) {
  if (!content_.write(content)) throw_io_error(file_, "written");
}

void AtomicFile::commit(const fs::path& previous) {
  // Some file systems report a full disk only here.
  if (::fsync(content_.number()) != 0 || !content_.close()) throw_io_error(file_, "written");
  if (!previous.empty() && std::rename(file_.c_str(), previous.c_str()) != 0 && errno != ENOENT)
    throw_io_error(file_, "renamed");
  if (std::rename(path().c_str(), file_.c_str()) != 0) throw_io_error(file_, "written");
  force_to_disk(folder_of(file_));
}

void replace_file(const fs::path& file, std::string_view content, const fs::path& previous) {
  AtomicFile aside(file);
  aside.write(content);
  aside.commit(previous);
}

bool is_left_aside(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with(aside_begin) && name.ends_with(aside_end);
}

void force_to_disk(const fs::path& path) {
  Descriptor opened(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (opened.number() < 0 || ::fsync(opened.number()) != 0) throw_io_error(path, "forced to the disk");
}

void make_folders(const fs::path& folder) {
  if (folder.empty() || fs::is_directory(folder)) return;
  make_folders(folder.parent_path());
  std::error_code error;
  if (!fs::create_directory(folder, error)) {
    if (error) throw IoError(folder.string() + ": cannot be made: " + error.message());
    return;
  }
  // A folder that may be written but not read cannot be opened, and so not be forced.
  if (const fs::path above = folder_of(folder); ::access(above.c_str(), R_OK) == 0) force_to_disk(above);
}

}  // namespace drumlin
