#pragma once
// Whole files, read and written so that nobody ever sees half of one.
#include <filesystem>
#include <string>
#include <string_view>

#include "coupling/core/files/descriptor.hpp"
#include "coupling/core/files/unfinished_file.hpp"

namespace drumlin {

/// Content of a file. Throws InputError if it is missing or no regular file, IoError if it cannot be read.
std::string file_text(const std::filesystem::path& file);

/// A file that is written aside, forced to the disk and renamed to its place, the folder being forced to the
/// disk too: a kill or a power cut leaves the old file or the new one. The file aside is new; a symbolic link
/// in the place of the file is replaced, not followed. It vanishes with this object unless it has taken its
/// place.
class AtomicFile {
 public:
  /// Makes it, empty. Throws IoError.
  explicit AtomicFile(const std::filesystem::path& file);

  /// Where it is to be written, if by something else than write().
  const std::filesystem::path& path() const { return unfinished_.path(); }
  /// Throws IoError.
  void write(std::string_view content);
  /// Nothing is written after it. An older file stays under the name `previous` of the same folder, if it is
  /// given: one of both is whole at any moment. Throws IoError, the older file then being intact, under one
  /// of both names.
  void commit(const std::filesystem::path& previous = {});

 private:
  std::filesystem::path file_;
  UnfinishedFile unfinished_;  // removes it wherever this process ends before the rename
  Descriptor content_;
};

/// Writes `content`, text or not, as an AtomicFile.
void replace_file(const std::filesystem::path& file, std::string_view content,
                  const std::filesystem::path& previous = {});

/// Whether a file of this name is what a killed replace_file() has left aside.
bool is_left_aside(const std::filesystem::path& file);

/// Forces the content of a file, or the names in a folder, to the disk. Throws IoError.
void force_to_disk(const std::filesystem::path& path);

/// Makes a folder and those above it that are missing, and forces the name of each new one to the disk: what
/// is forced to the disk within it outlives a power cut only if its name does. Throws IoError.
void make_folders(const std::filesystem::path& folder);

}  // namespace drumlin
