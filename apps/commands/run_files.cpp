#include "apps/commands/run_files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include "coupling/common/errors.hpp"

namespace drumlin::apps {

namespace fs = std::filesystem;

particles::Scene as_recorded(particles::Scene scene) {
  if (auto* listed = std::get_if<particles::ListedGrains>(&scene.grains.source)) listed->file = grain_list;
  return scene;
}

RunTable::RunTable(const fs::path& file, const std::string& header, std::int64_t keep_bytes) : file_(file) {
  if (keep_bytes > 0) {
    if (!fs::exists(file) || fs::file_size(file) < static_cast<std::uintmax_t>(keep_bytes))
      throw InputError(file.string() +
                       ": is missing or shorter than the checkpoint says; start over with --overwrite");
    fs::resize_file(file, static_cast<std::uintmax_t>(keep_bytes));
  }
  out_.open(file, keep_bytes > 0 ? std::ios::app : std::ios::trunc);
  bytes_ = keep_bytes;
  if (keep_bytes == 0) write(header);
}

void RunTable::write(const std::string& line) {
  out_ << line;
  bytes_ += static_cast<std::int64_t>(line.size());
}

std::int64_t RunTable::flush() {
  out_.flush();
  if (!out_) throw IoError(file_.string() + ": cannot write");
  // A checkpoint that outlives a power cut must not speak of lines that did not.
  const int descriptor = ::open(file_.c_str(), O_WRONLY);
  const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
  if (descriptor >= 0) ::close(descriptor);
  if (!synced) throw IoError(file_.string() + ": cannot sync");
  return bytes_;
}

}  // namespace drumlin::apps
