#pragma once
// Thread pool: threads that work on one solve together and meet many thousand times a second.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

namespace drumlin::particles {

/// Barrier of a number of threads. A thread that waits spins for some microseconds and then sleeps, so that
/// it leaves its processor to others.
class Barrier {
 public:
  explicit Barrier(int threads) : threads_(threads) {}
  void wait();

 private:
  friend class ThreadPool;
  int threads_;
  alignas(64) std::atomic<int> arrived_{0};
  alignas(64) std::atomic<std::uint32_t> round_{0};
};

/// The calling thread and size() - 1 helpers, which sleep between two jobs.
///
/// Where other processes take the processors, threads wait for one that does not run. So the pool looks now
/// and then how often the system has taken a processor away from this process, and leaves the next jobs to
/// the calling thread where that was often. Shares of a job must not decide its result: it may be given 1 or
/// size() threads. A process that fork() made of this one has no helpers: there it works alone.
class ThreadPool {
 public:
  /// Throws std::system_error if the system gives no more threads, and std::bad_alloc.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int size() const { return static_cast<int>(members_.size()); }
  /// Number of threads that the next job is given.
  int threads() const { return barrier_.threads_; }
  /// Calls job(t, threads) for t in [0, threads), each on a thread of its own, and returns when all have
  /// returned. An exception of a job is thrown here then, that of the lowest t; jobs that meet must not
  /// throw, or others wait for ever.
  void run(const std::function<void(int, int)>& job);
  /// Where the threads of a job meet; all of them call it.
  void barrier() { barrier_.wait(); }

 private:
  struct alignas(64) Member {
    std::atomic<std::uint32_t> jobs{0};
    std::exception_ptr error;
  };
  void help(int t);
  void work(int t) noexcept;
  void choose_threads();
  void forget_lost_helpers();
  void end();

  Barrier barrier_;
  std::vector<Member> members_;
  const std::function<void(int, int)>* job_ = nullptr;
  std::atomic<int> running_{0};
  std::atomic<bool> over_{false};
  std::chrono::steady_clock::time_point next_choice_{};
  long taken_away_ = 0;  // processors, so far
  std::vector<std::thread> helpers_;
  int owner_;  // the process that started them
};

}  // namespace drumlin::particles
