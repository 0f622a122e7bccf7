#include "coupling/common/files/text_file.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include "coupling/common/errors.hpp"
#include "coupling/common/files/input_file.hpp"
#include "coupling/common/files/own_folder.hpp"
#include "coupling/common/files/unfinished_file.hpp"

namespace drumlin {

std::string file_text(const std::filesystem::path& file) { return input_bytes(file, largest_text_file); }

namespace {

namespace fs = std::filesystem;

constexpr std::string_view aside_begin = ".drumlin-", aside_end = ".part";
constexpr std::size_t aside_letters = 32;

std::string unguessable_name(const fs::path& file) {
  std::array<unsigned char, aside_letters / 2> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw_io_error(file, "written");
  std::string name(aside_begin);
  for (const unsigned char byte : bytes)
    name += {"0123456789abcdef"[byte / 16], "0123456789abcdef"[byte % 16]};
  return name.append(aside_end);
}

/// A file of the folder of `file` that takes its place when it is whole, and vanishes otherwise.
class FileAside {
 public:
  explicit FileAside(const fs::path& file)
      : file_(file),
        folder_(file.has_parent_path() ? file.parent_path() : "."),
        descriptor_(open_folder(file.parent_path())) {
    if (descriptor_.number() < 0) throw_io_error(file_, "written");
    refuse_special(file_);
  }
  FileAside(const FileAside&) = delete;
  FileAside& operator=(const FileAside&) = delete;

  /// A new file.
  Descriptor made() {
    name_ = unguessable_name(file_);
    unfinished_.emplace(folder_ / name_);
    Descriptor aside(::openat(descriptor_.number(), name_.c_str(),
                              O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
    if (aside.number() < 0) throw_io_error(file_, "written");
    return aside;
  }

  void write(std::string_view content) {
    Descriptor aside = made();
    while (!content.empty()) {
      const ssize_t bytes = ::write(aside.number(), content.data(), content.size());
      if (bytes < 0 && errno == EINTR) continue;
      if (bytes < 0) throw_io_error(file_, "written");
      content.remove_prefix(static_cast<std::size_t>(bytes));
    }
    settle(aside);
  }

  /// Forces it to the disk. Some file systems report a full disk only here.
  void settle(Descriptor& aside) const {
    if (::fsync(aside.number()) != 0 || !aside.close()) throw_io_error(file_, "written");
  }

  const fs::path& path() const { return unfinished_->path(); }

  void take_the_place() {
    if (!rename(name_, file_.filename())) throw_io_error(file_, "written");
    if (::fsync(descriptor_.number()) != 0) throw_io_error(file_, "forced to the disk");
  }

  /// Gives the older file another name, if there is one.
  void keep(const fs::path& previous) const {
    if (!rename(file_.filename(), previous.filename()) && errno != ENOENT) throw_io_error(file_, "renamed");
  }

  /// Renames within the folder.
  bool rename(const fs::path& from, const fs::path& to) const {
    return ::renameat(descriptor_.number(), from.c_str(), descriptor_.number(), to.c_str()) == 0;
  }

 private:
  fs::path file_, folder_;
  Descriptor descriptor_;
  std::string name_;
  std::optional<UnfinishedFile> unfinished_;  // removes it wherever this process ends before the rename
};

}  // namespace

void replace_file(const fs::path& file, std::string_view content) {
  FileAside aside(file);
  aside.write(content);
  aside.take_the_place();
}

void replace_file_keeping(const fs::path& file, const fs::path& previous, std::string_view content) {
  FileAside aside(file);
  aside.write(content);
  aside.keep(previous);
  aside.take_the_place();
}

struct FileInTheMaking::Aside {
  explicit Aside(const fs::path& file) : place(file), content(place.made()) {}
  FileAside place;
  Descriptor content;
};

FileInTheMaking::FileInTheMaking(const fs::path& file) : aside_(std::make_unique<Aside>(file)) {}
FileInTheMaking::~FileInTheMaking() = default;

const fs::path& FileInTheMaking::path() const { return aside_->place.path(); }

void FileInTheMaking::take_the_place() {
  aside_->place.settle(aside_->content);
  aside_->place.take_the_place();
}

void FileInTheMaking::take_the_place_keeping(const fs::path& previous) {
  aside_->place.settle(aside_->content);
  aside_->place.keep(previous);
  aside_->place.take_the_place();
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
