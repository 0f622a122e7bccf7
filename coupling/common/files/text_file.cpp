#include "coupling/common/files/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>

#include "coupling/common/errors.hpp"
#include "coupling/common/files/input_file.hpp"

namespace drumlin {

std::string file_text(const std::filesystem::path& file) { return input_bytes(file, largest_text_file); }

namespace {

namespace fs = std::filesystem;

constexpr std::string_view aside_begin = ".drumlin-", aside_end = ".part";
constexpr std::size_t aside_letters = 32;

fs::path unguessable_name_beside(const fs::path& file) {
  std::array<std::uint64_t, 2> bits{};
  if (::getrandom(bits.data(), sizeof bits, 0) != sizeof bits) throw_io_error(file, "written");
  return file.parent_path() / fmt::format("{}{:016x}{:016x}{}", aside_begin, bits[0], bits[1], aside_end);
}

Descriptor folder_of(const fs::path& file) {
  Descriptor folder = open_folder(file.parent_path());
  if (folder.number() < 0) throw_io_error(file, "written");
  refuse_special(file);
  return folder;
}

}  // namespace

FileInTheMaking::FileInTheMaking(const fs::path& file)
    : file_(file),
      folder_(folder_of(file)),
      unfinished_(unguessable_name_beside(file)),
      content_(::openat(folder_.number(), path().filename().c_str(),
                        O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666)) {
  if (content_.number() < 0) throw_io_error(file_, "written");
}

void FileInTheMaking::write(std::string_view content) {
  if (!content_.write(content)) throw_io_error(file_, "written");
}

void FileInTheMaking::take_the_place(const fs::path& previous) {
  const auto rename = [&](const fs::path& from, const fs::path& to) {
    return ::renameat(folder_.number(), from.filename().c_str(), folder_.number(), to.filename().c_str()) ==
           0;
  };
  // Some file systems report a full disk only here.
  if (::fsync(content_.number()) != 0 || !content_.close()) throw_io_error(file_, "written");
  if (!previous.empty() && !rename(file_, previous) && errno != ENOENT) throw_io_error(file_, "renamed");
  if (!rename(path(), file_)) throw_io_error(file_, "written");
  if (::fsync(folder_.number()) != 0) throw_io_error(file_, "forced to the disk");
}

void replace_file(const fs::path& file, std::string_view content, const fs::path& previous) {
  FileInTheMaking aside(file);
  aside.write(content);
  aside.take_the_place(previous);
}

bool is_left_aside(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.size() == aside_begin.size() + aside_letters + aside_end.size() &&
         name.starts_with(aside_begin) && name.ends_with(aside_end);
}

void force_to_disk(const fs::path& path) {
  Descriptor opened(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (opened.number() < 0 || ::fsync(opened.number()) != 0) throw_io_error(path, "forced to the disk");
}

void make_folders(const fs::path& folder) {
  if (folder.empty()) return;
  const Descriptor there = open_folder(folder);  // refuses links
  if (there.number() >= 0 || fs::is_directory(folder)) return;
  const fs::path above = folder.parent_path();
  make_folders(above);
  std::error_code error;
  if (!fs::create_directory(folder, error)) {
    if (error) throw IoError(folder.string() + ": cannot be made: " + error.message());
    return;
  }
  const Descriptor opened = open_folder(above);
  // A folder that may be written but not read cannot be opened, and so not be forced.
  if (opened.number() < 0 && errno == EACCES) return;
  if (opened.number() < 0 || ::fsync(opened.number()) != 0) throw_io_error(folder, "forced to the disk");
}

}  // namespace drumlin
