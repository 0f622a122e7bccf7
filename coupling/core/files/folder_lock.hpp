#pragma once
// A lock that one process at a time holds on what it writes; it ends with the process, however that ends.
#include <filesystem>
#include <memory>
#include <string>

#include "coupling/core/files/descriptor.hpp"
#include "coupling/core/files/unfinished_file.hpp"

namespace drumlin {

/// The name of the lock file in a result folder.
inline constexpr const char* folder_lock_name = ".lock";

/// flock(2) on a file that exists only as long as the lock is held; signals that end the process remove it
/// too. A file that a killed process left is no obstacle.
class FolderLock {
 public:
  /// `command`: who holds it, for whom it keeps out. Throws InputError that names the holder (process,
  /// command, since when) if another one holds it; IoError if the file cannot be made.
  FolderLock(const std::filesystem::path& file, const std::string& command);

 private:
  Descriptor held_;
  // Goes before it, while the lock is held: whoever has opened it meanwhile sees that it has gone.
  std::unique_ptr<UnfinishedFile> named_;
};

/// Now, as "2026-03-14 15:09:26 UTC".
std::string time_text();

}  // namespace drumlin
