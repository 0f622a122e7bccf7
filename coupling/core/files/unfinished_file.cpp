#include "coupling/core/files/unfinished_file.hpp"

#include <unistd.h>

#include <array>
#include <thread>
#include <utility>

namespace drumlin {
namespace {

/// Names of files, where a signal handler finds them: it can read nothing that is not static. nullptr: a free
/// place; `taken`: a handler is about to remove the file and to end the process. More files at once than
/// places: the rest is removed by their objects only.
std::array<std::atomic<const char*>, 8> noted_names;
static_assert(decltype(noted_names)::value_type::is_always_lock_free, "a signal handler reads it");
constexpr char taken = 0;

}  // namespace

UnfinishedFile::UnfinishedFile(std::filesystem::path file) : file_(std::move(file)) {
  for (std::atomic<const char*>& name : noted_names)
    if (const char* none = nullptr; name.compare_exchange_strong(none, file_.c_str())) {
      noted_ = &name;
      return;
    }
}

UnfinishedFile::~UnfinishedFile() {
  ::unlink(file_.c_str());
  if (noted_ == nullptr) return;
  for (const char* own = file_.c_str(); !noted_->compare_exchange_weak(own, nullptr); own = file_.c_str())
    std::this_thread::yield();
}

void remove_unfinished_files() noexcept {
  for (std::atomic<const char*>& name : noted_names)
    if (const char* file = name.exchange(&taken); file != nullptr && file != &taken) ::unlink(file);
}

}  // namespace drumlin
