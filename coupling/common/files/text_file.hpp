#pragma once
// Whole files, read and written so that nobody ever sees half of one.
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace drumlin {

/// Content of a file. Throws InputError if it is missing or no regular file, IoError if it cannot be read.
std::string file_text(const std::filesystem::path& file);

/// Writes `content`, text or not, aside, forces it to the disk, renames it to `file` and forces the folder to
/// the disk: a kill or a power cut leaves the old file or the new one. The place aside is new and has a name
/// that nobody can guess; a symbolic link in the place of `file` is replaced, not followed. Throws IoError,
/// and InputError where a device, a FIFO or a socket has the name, or the way leads over a link below an
/// OwnFolder; what was there is then intact.
void replace_file(const std::filesystem::path& file, std::string_view content);

/// The same, and the old file stays under the name `previous`, of the same folder: one of both is whole at
/// any moment.
void replace_file_keeping(const std::filesystem::path& file, const std::filesystem::path& previous,
                          std::string_view content);

/// A file that something else writes, aside as replace_file() does: it takes the place of `file` when it is
/// whole, or vanishes with this object.
class FileInTheMaking {
 public:
  /// Makes it, empty. Throws as replace_file().
  explicit FileInTheMaking(const std::filesystem::path& file);
  ~FileInTheMaking();
  FileInTheMaking(const FileInTheMaking&) = delete;
  FileInTheMaking& operator=(const FileInTheMaking&) = delete;

  /// Where it is to be written.
  const std::filesystem::path& path() const;
  /// Forces it to the disk and renames it. Throws IoError, the old file then being intact.
  void take_the_place();
  /// The same, the older file staying under the name `previous`, in the same folder; where it throws, under
  /// one of both.
  void take_the_place_keeping(const std::filesystem::path& previous);

 private:
  struct Aside;
  std::unique_ptr<Aside> aside_;
};

/// Whether a file of this name is what a killed replace_file() has left aside.
bool is_left_aside(const std::filesystem::path& file);

/// Forces the content of a file, or the names in a folder, to the disk. Throws IoError.
void force_to_disk(const std::filesystem::path& path);

/// Makes a folder and those above it that are missing, and forces the name of each new one to the disk: what
/// is forced to the disk within it outlives a power cut only if its name does. Throws IoError, and InputError
/// as open_folder().
void make_folders(const std::filesystem::path& folder);

}  // namespace drumlin
