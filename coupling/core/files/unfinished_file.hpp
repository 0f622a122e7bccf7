#pragma once
// A file that is not whole yet and must not be left behind, however this process ends, short of kill -9.
#include <atomic>
#include <filesystem>

namespace drumlin {

/// The name of a file that is being written aside. The file is removed when this object goes, and when a
/// signal ends the process before that. Renamed to its final name it is whole, and nothing is left to remove.
class UnfinishedFile {
 public:
  /// Made before the file is, so that no moment is missed.
  explicit UnfinishedFile(std::filesystem::path file);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  const std::filesystem::path& path() const { return file_; }

 private:
  std::filesystem::path file_;
  std::atomic<const char*>* noted_ =
      nullptr;  // where a signal handler finds the name; too many at once: nowhere
};

/// Removes the files of all UnfinishedFile of this process. For signal handlers: it allocates nothing and
/// waits for nobody. The process must end after it.
void remove_unfinished_files() noexcept;

}  // namespace drumlin
