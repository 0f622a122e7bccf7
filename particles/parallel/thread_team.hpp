#pragma once
// Thread team: threads that work on one solve together and meet many thousand times a second.
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace drumlin::particles {

/// Barrier of a fixed number of threads. Spins, then yields, so that it still works with more threads than
/// processors.
class Barrier {
 public:
  explicit Barrier(int threads) : threads_(threads) {}
  void meet();

 private:
  int threads_;
  alignas(64) std::atomic<int> arrived_{0};
  alignas(64) std::atomic<std::uint32_t> round_{0};
};

/// The calling thread and size() - 1 helpers, which sleep between two jobs.
class ThreadTeam {
 public:
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return static_cast<int>(helpers_.size()) + 1; }
  /// Calls job(t) for t in [0, size()), each on a thread of its own, and returns when all have returned. Jobs
  /// must not throw.
  void run(const std::function<void(int)>& job);
  /// Where the threads of a job meet.
  Barrier& barrier() { return barrier_; }

 private:
  void help(int t);

  Barrier barrier_;
  const std::function<void(int)>* job_ = nullptr;
  std::atomic<std::uint32_t> started_{0};
  std::atomic<int> running_{0};
  std::atomic<bool> over_{false};
  std::vector<std::thread> helpers_;
};

}  // namespace drumlin::particles
