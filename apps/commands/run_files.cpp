#include "apps/commands/run_files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/input_file.hpp"
#include "coupling/core/files/last_whole.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/io/run_folder.hpp"

namespace drumlin::apps {

namespace fs = std::filesystem;

namespace {
constexpr std::size_t largest_waiting = 1 << 16;  // bytes
}

std::vector<std::string> run_file_names() {
  return {"scene.toml",
          particles::grain_list,
          "grains-*.csv",
          "run.json",
          "log.csv",
          "energy.csv",
          "walls.csv",
          "regions.csv",
          checkpoint_name,
          previous_checkpoint_name,
          passed_over_checkpoint_name,
          "snapshots/*.h5",
          "problems/*.h5"};
}

RunTable::RunTable(const fs::path& file, const std::string& header, std::int64_t keep_bytes) : file_(file) {
  if (keep_bytes > 0) {
    if (!fs::exists(file) || fs::file_size(file) < static_cast<std::uintmax_t>(keep_bytes))
      throw InputError(file.string() +
                       ": is missing or shorter than the checkpoint says; start over with --overwrite");
    sum_ = checksum_of(file, static_cast<std::uint64_t>(keep_bytes));
  }
  opened_ = Descriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (opened_.number() < 0) throw_io_error(file, "opened");
  if (::ftruncate(opened_.number(), keep_bytes) != 0 || ::lseek(opened_.number(), 0, SEEK_END) != keep_bytes)
    throw_io_error(file, "cut back");
  bytes_ = keep_bytes;
  if (keep_bytes == 0) write(header);
}

void RunTable::write(const std::string& line) {
  waiting_ += line;
  sum_.add(line);
  bytes_ += static_cast<std::int64_t>(line.size());
  if (waiting_.size() >= largest_waiting) drain();
}

void RunTable::drain() {
  if (!opened_.write(waiting_)) throw_io_error(file_, "written");
  waiting_.clear();
}

std::int64_t RunTable::flush() {
  drain();
  // A checkpoint that outlives a power cut must not speak of lines that did not.
  if (::fsync(opened_.number()) != 0) throw_io_error(file_, "forced to the disk");
  return bytes_;
}

}  // namespace drumlin::apps
