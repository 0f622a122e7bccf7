#include "particles/parallel/thread_pool.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <system_error>
#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace drumlin::particles {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::microseconds longest_spin{30};  // to fall asleep and to be woken takes about as long
// Time between two jobs before a helper sleeps: a step's serial parts are shorter, and each job would else
// begin with a thread to wake. It leaves its processor to anybody who wants it meanwhile.
constexpr std::chrono::milliseconds longest_pause{1};

// Of stores that wake threads. notify_one() and notify_all() ask whether anybody sleeps, without a barrier of
// their own: were the value stored with less, that could be answered before the store is seen, by "nobody",
// while the sleeper still sees the old value, and all would sleep for ever.
constexpr auto whole_order = std::memory_order_seq_cst;

void pause() {
#if defined(__x86_64__)
  _mm_pause();
#endif
}

/// Waits until `value` is no longer `old`: spins, yields for the time `awake` in all, then sleeps.
template <class T>
void wait_for_change(const std::atomic<T>& value, T old, Clock::duration awake = {}) {
  constexpr int spins_between_clocks = 32;
  const auto changed = [&] { return value.load(std::memory_order_acquire) != old; };
  if (changed()) return;
  const auto start = Clock::now();
  while (Clock::now() - start < longest_spin)
    for (int spin = 0; spin < spins_between_clocks; ++spin) {
      if (changed()) return;
      pause();
    }
  while (Clock::now() - start < awake) {
    if (changed()) return;
    std::this_thread::yield();
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

void Barrier::wait() {
  const std::uint32_t round = round_.load(std::memory_order_relaxed);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) < threads_ - 1) return wait_for_change(round_, round);
  arrived_.store(0, std::memory_order_relaxed);
  round_.store(round + 1, whole_order);
  round_.notify_all();
}

ThreadPool::ThreadPool(int threads)
    : barrier_(threads), members_(static_cast<std::size_t>(threads)), owner_(getpid()) {
  try {
    for (int t = 1; t < threads; ++t) helpers_.emplace_back([this, t] { help(t); });
  } catch (const std::system_error& error) {
    end();
    throw std::system_error(error.code(), std::to_string(threads) + " threads cannot be started");
  } catch (...) {
    end();
    throw;
  }
}

ThreadPool::~ThreadPool() { end(); }

void ThreadPool::forget_lost_helpers() {
  if (getpid() == owner_) return;
  for (auto& helper : helpers_) helper.detach();
  helpers_.clear();
  barrier_.threads_ = 1;
}

void ThreadPool::end() {
  forget_lost_helpers();
  over_ = true;
  for (auto& member : members_) {
    member.jobs.fetch_add(1, whole_order);
    member.jobs.notify_one();
  }
  for (auto& helper : helpers_) helper.join();
}

void ThreadPool::run(const std::function<void(int, int)>& job) {
  forget_lost_helpers();
  if (helpers_.empty()) return job(0, 1);
  choose_threads();
  if (threads() == 1) return job(0, 1);
  job_ = &job;
  running_.store(size() - 1, std::memory_order_relaxed);
  for (std::size_t t = 1; t < members_.size(); ++t) {
    members_[t].jobs.fetch_add(1, whole_order);
    members_[t].jobs.notify_one();
  }
  work(0);
  for (int left = running_.load(std::memory_order_acquire); left > 0;
       left = running_.load(std::memory_order_acquire))
    wait_for_change(running_, left);
  std::exception_ptr first;
  for (auto& member : members_)
    if (const auto error = std::exchange(member.error, nullptr); error && !first) first = error;
  if (first) std::rethrow_exception(first);
}

void ThreadPool::choose_threads() {
  // On an idle machine a processor is taken away some ten times a second, beside another process every few
  // milliseconds. To try all threads again may cost a tenth of the time.
  constexpr std::chrono::milliseconds with_all{50}, alone{500};
  constexpr double often = 100;  // a second
  const auto now = Clock::now();
  if (now < next_choice_) return;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto taken = static_cast<double>(usage.ru_nivcsw - std::exchange(taken_away_, usage.ru_nivcsw));
  const std::chrono::duration<double> since = now - next_choice_ + with_all;
  const bool busy = threads() > 1 && taken >= often * since.count();
  barrier_.threads_ = busy ? 1 : size();
  next_choice_ = now + (busy ? Clock::duration(alone) : with_all);
}

void ThreadPool::work(int t) noexcept {
  try {
    (*job_)(t, threads());
  } catch (...) {
    // The others may still work on what the caller of run() would give up.
    members_[static_cast<std::size_t>(t)].error = std::current_exception();
  }
}

void ThreadPool::help(int t) {
  auto& jobs = members_[static_cast<std::size_t>(t)].jobs;
  for (std::uint32_t done = 0;; ++done) {
    wait_for_change(jobs, done, longest_pause);
    if (over_) return;
    work(t);
    if (running_.fetch_sub(1, whole_order) == 1) running_.notify_one();
  }
}

}  // namespace drumlin::particles
