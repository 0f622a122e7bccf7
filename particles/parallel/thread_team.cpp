#include "particles/parallel/thread_team.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace drumlin::particles {
namespace {

constexpr int spins_before_yielding = 4000;   // some 20 microseconds
constexpr int yields_before_sleeping = 2000;  // between jobs only

void pause() {
#if defined(__x86_64__)
  _mm_pause();
#endif
}

}  // namespace

void Barrier::meet() {
  if (threads_ == 1) return;
  const std::uint32_t round = round_.load(std::memory_order_relaxed);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) == threads_ - 1) {
    arrived_.store(0, std::memory_order_relaxed);
    round_.store(round + 1, std::memory_order_release);
    return;
  }
  for (int spins = 0; round_.load(std::memory_order_acquire) == round; ++spins)
    if (spins < spins_before_yielding)
      pause();
    else
      std::this_thread::yield();
}

ThreadTeam::ThreadTeam(int threads) : barrier_(threads) {
  for (int t = 1; t < threads; ++t) helpers_.emplace_back([this, t] { help(t); });
}

ThreadTeam::~ThreadTeam() {
  over_ = true;
  started_.fetch_add(1, std::memory_order_release);
  started_.notify_all();
  for (auto& helper : helpers_) helper.join();
}

void ThreadTeam::run(const std::function<void(int)>& job) {
  if (helpers_.empty()) return job(0);
  job_ = &job;
  running_.store(static_cast<int>(helpers_.size()), std::memory_order_relaxed);
  started_.fetch_add(1, std::memory_order_release);
  started_.notify_all();
  job(0);
  for (int spins = 0; running_.load(std::memory_order_acquire) > 0; ++spins)
    if (spins < spins_before_yielding)
      pause();
    else
      std::this_thread::yield();
}

void ThreadTeam::help(int t) {
  for (std::uint32_t seen = 0;;) {
    for (int spins = 0; started_.load(std::memory_order_acquire) == seen; ++spins) {
      if (spins < spins_before_yielding)
        pause();
      else if (spins < spins_before_yielding + yields_before_sleeping)
        std::this_thread::yield();
      else
        started_.wait(seen, std::memory_order_acquire);
    }
    ++seen;
    if (over_) return;
    (*job_)(t);
    running_.fetch_sub(1, std::memory_order_release);
  }
}

}  // namespace drumlin::particles
