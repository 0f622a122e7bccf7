#include "coupling/common/files/unfinished_file.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <cstring>
#include <thread>
#include <utility>

namespace drumlin {
namespace {

/// Who may touch the name of a slot: its owner while it is `written`, nobody else but a handler once `taken`.
enum class Use : int { free, written, named, taken };
static_assert(std::atomic<Use>::is_always_lock_free, "a signal handler reads it");

struct Slot {
  std::atomic<Use> use{Use::free};
  std::array<char, PATH_MAX> name{};
};

// A signal handler finds nothing that is not static. More files at once than slots: the rest is removed by
// their objects only.
std::array<Slot, 8> slots;

int noted(const std::filesystem::path& file) {
  if (file.native().size() >= PATH_MAX) return -1;
  for (std::size_t s = 0; s < slots.size(); ++s) {
    Use expected = Use::free;
    if (!slots[s].use.compare_exchange_strong(expected, Use::written)) continue;
    std::memcpy(slots[s].name.data(), file.c_str(), file.native().size() + 1);
    slots[s].use.store(Use::named);
    return static_cast<int>(s);
  }
  return -1;
}

void forget(int slot) {
  if (slot < 0) return;
  Use expected = Use::named;
  // A handler that has taken the name is about to remove the file and to end the process.
  while (!slots[static_cast<std::size_t>(slot)].use.compare_exchange_weak(expected, Use::free)) {
    expected = Use::named;
    std::this_thread::yield();
  }
}

}  // namespace

UnfinishedFile::UnfinishedFile(std::filesystem::path file) : file_(std::move(file)), slot_(noted(file_)) {}

UnfinishedFile::~UnfinishedFile() {
  ::unlink(file_.c_str());
  forget(slot_);
}

void remove_unfinished_files() noexcept {
  for (Slot& slot : slots) {
    Use expected = Use::named;
    if (slot.use.compare_exchange_strong(expected, Use::taken)) ::unlink(slot.name.data());
  }
}

}  // namespace drumlin
