#include "apps/process/memory_reserve.hpp"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace drumlin::apps {
namespace {

constexpr std::size_t reserve_bytes = std::size_t{1} << 20;
std::atomic<void*> reserve = nullptr;
std::atomic<bool> was_short = false;

void use_reserve() {
  was_short = true;
  void* const memory = reserve.exchange(nullptr);
  if (memory == nullptr) throw std::bad_alloc();
  std::free(memory);
}

}  // namespace

void keep_memory_in_reserve() {
  reserve = std::malloc(reserve_bytes);
  std::set_new_handler(use_reserve);
}

void end_if_memory_was_short() {
  if (was_short) throw std::bad_alloc();
}

}  // namespace drumlin::apps
