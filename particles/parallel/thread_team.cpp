#include "particles/parallel/thread_team.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <string>
#include <system_error>
#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace drumlin::particles {
namespace {

constexpr double longest_spin = 30e-6;  // seconds; to fall asleep and to be woken takes about as long
// Seconds between two jobs before a helper sleeps: a step's serial parts are shorter, and each job would else
// begin with a thread to wake. It leaves its processor to anybody who wants it meanwhile.
constexpr double longest_pause = 1e-3;
constexpr double stretch = 20e-3;    // seconds of jobs that tell whether the threads wait too much
constexpr double least_share = 0.5;  // of the time, that threads must work
// To ask for processor times takes most of a microsecond, as long as a short job: one job in so many does, a
// prime, since steps repeat.
constexpr int jobs_per_look = 7;
// A stretch is judged by at least this part of its time.
constexpr double least_seen = 0.5 / jobs_per_look;

// Of what is told to threads that may sleep. notify_one() and notify_all() ask whether anybody sleeps,
// without a barrier of their own: were the value stored with less, that could be answered before the store is
// seen, by "nobody", while the sleeper still sees the old value, and all would sleep for ever.
constexpr auto whole_order = std::memory_order_seq_cst;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Processor time of the calling thread, in seconds.
double processor_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void pause() {
#if defined(__x86_64__)
  _mm_pause();
#endif
}

/// Waits until `value` is no longer `old`: spins, yields up to `awake` seconds, then sleeps. Returns the
/// seconds spent spinning.
template <class T>
double wait_for_change(const std::atomic<T>& value, T old, double awake = 0) {
  constexpr int spins_between_looks = 32;
  if (value.load(std::memory_order_acquire) != old) return 0;
  const double start = now();
  for (double spun = 0; spun < longest_spin; spun = now() - start)
    for (int spin = 0; spin < spins_between_looks; ++spin) {
      if (value.load(std::memory_order_acquire) != old) return std::min(now() - start, longest_spin);
      pause();
    }
  while (now() - start < awake) {
    if (value.load(std::memory_order_acquire) != old) return longest_spin;
    std::this_thread::yield();
  }
  value.wait(old, std::memory_order_acquire);
  return longest_spin;
}

}  // namespace

double Barrier::meet() {
  if (threads_ == 1) return 0;
  const std::uint32_t round = round_.load(std::memory_order_relaxed);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) < threads_ - 1) return wait_for_change(round_, round);
  arrived_.store(0, std::memory_order_relaxed);
  round_.store(round + 1, whole_order);
  round_.notify_all();
  return 0;
}

ThreadTeam::ThreadTeam(int threads) : barrier_(threads), members_(static_cast<std::size_t>(threads)) {
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

ThreadTeam::~ThreadTeam() { end(); }

void ThreadTeam::end() {
  over_ = true;
  for (auto& member : members_) {
    member.jobs.fetch_add(1, whole_order);
    member.jobs.notify_one();
  }
  for (auto& helper : helpers_) helper.join();
}

void ThreadTeam::run(const std::function<void(int, int)>& job) {
  if (helpers_.empty()) return job(0, 1);
  const double start = now();
  looks_ = jobs_run_++ % jobs_per_look == 0;
  job_ = &job;
  const int helping = threads() - 1;
  running_.store(helping, std::memory_order_relaxed);
  for (int t = 1; t <= helping; ++t) {
    auto& jobs = members_[static_cast<std::size_t>(t)].jobs;
    jobs.fetch_add(1, whole_order);
    jobs.notify_one();
  }
  work(0);
  for (int left = running_.load(std::memory_order_acquire); left > 0;
       left = running_.load(std::memory_order_acquire))
    (void)wait_for_change(running_, left);
  choose_threads(now() - start);
  rethrow();
}

/// Throws what a thread has thrown in the job that is over.
void ThreadTeam::rethrow() {
  for (auto& member : members_)
    if (member.thrown) {
      const std::exception_ptr first = std::exchange(member.thrown, nullptr);
      for (auto& other : members_) other.thrown = nullptr;
      std::rethrow_exception(first);
    }
}

void ThreadTeam::work(int t) noexcept {
  try {
    do_share(t);
  } catch (...) {
    // The others may still work on what the caller of run() would give up.
    members_[static_cast<std::size_t>(t)].thrown = std::current_exception();
  }
}

void ThreadTeam::do_share(int t) {
  if (!looks_) return (*job_)(t, threads());
  Member& self = members_[static_cast<std::size_t>(t)];
  self.spun = 0;
  const double start = processor_time();
  (*job_)(t, threads());
  self.worked = processor_time() - start - self.spun;
}

void ThreadTeam::help(int t) {
  auto& jobs = members_[static_cast<std::size_t>(t)].jobs;
  for (std::uint32_t seen = 0;; ++seen) {
    (void)wait_for_change(jobs, seen, longest_pause);
    if (over_) return;
    work(t);
    if (running_.fetch_sub(1, whole_order) == 1) running_.notify_one();
  }
}

/// After a job that took `passed` seconds. No thread but the calling one is at work.
void ThreadTeam::choose_threads(double passed) {
  if (until_ > 0 && (until_ -= passed) <= 0) {
    barrier_.threads_ = size();
    worked_ = looked_ = passed_ = 0;
    return;
  }
  const int count = threads();
  if (count == 1) return;
  passed_ += passed;
  if (looks_) {
    looked_ += passed;
    for (int t = 0; t < count; ++t) worked_ += std::max(0.0, members_[static_cast<std::size_t>(t)].worked);
  }
  if (passed_ < stretch || looked_ < least_seen * passed_) return;
  const bool waited = worked_ < least_share * count * looked_;
  if (waited) {
    barrier_.threads_ = std::max(1, count / 2);
    until_ = fewer_for_ * passed_;
  }
  fewer_for_ = std::clamp(fewer_for_ * (waited ? 2 : 0.9), fewer_at_first, fewer_at_last);
  worked_ = looked_ = passed_ = 0;
}

}  // namespace drumlin::particles
