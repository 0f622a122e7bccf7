#pragma once
// Files that a run writes while it computes: tables that are cut back on resuming, and a writer of HDF5 files
// beside the computation.
#include <cstdint>
#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include "coupling/core/files/descriptor.hpp"
#include "coupling/core/files/manifest.hpp"

namespace drumlin::apps {

/// Names of all files of a run.
std::vector<std::string> run_file_names();

/// A table of a run, one line per logged step; on resuming cut back to the length that the checkpoint names.
class RunTable {
 public:
  /// `header` begins a new file; with `keep_bytes` > 0 the file must be there with at least so many bytes
  /// (InputError).
  RunTable(const std::filesystem::path& file, const std::string& header, std::int64_t keep_bytes);

  void write(const std::string& line);
  /// Everything so far reaches the disk (else IoError); returns the length of the file.
  std::int64_t flush();
  /// Of everything so far, as the manifest of an unfinished run has it.
  ManifestEntry entry() const { return {{static_cast<std::uint64_t>(bytes_), sum_.text()}, true}; }

 private:
  void drain();
  std::filesystem::path file_;
  Descriptor opened_{-1};
  std::string waiting_;  ///< not yet handed to the system
  Checksum sum_;
  std::int64_t bytes_ = 0;
};

/// Files of a run, one at a time; with more than one thread beside the computation.
class BackgroundWriter {
 public:
  explicit BackgroundWriter(bool in_background)
      : policy_(in_background ? std::launch::async : std::launch::deferred) {}
  template <class Job>
  void write(Job job) {
    wait();
    pending_ = std::async(policy_, std::move(job));
    if (policy_ == std::launch::deferred) wait();
  }
  /// Rethrows what the last job threw.
  void wait() {
    if (pending_.valid()) pending_.get();
  }

 private:
  std::launch policy_;
  std::future<void> pending_;
};

}  // namespace drumlin::apps
