#pragma once
// Thread team: threads that work on one solve together and meet many thousand times a second.
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace drumlin::particles {

/// Barrier of a number of threads. Who waits spins for some microseconds and then sleeps, so that a processor
/// that another process wants is left to it.
class Barrier {
 public:
  explicit Barrier(int threads) : threads_(threads) {}
  /// Waits for the others; returns the seconds that this thread has spun for.
  double meet();

 private:
  friend class ThreadTeam;
  int threads_;
  alignas(64) std::atomic<int> arrived_{0};
  alignas(64) std::atomic<std::uint32_t> round_{0};
};

/// The calling thread and up to size() - 1 helpers, which sleep between two jobs.
///
/// Where other processes want the processors too, threads wait for one that is not running. The team compares
/// the processor time that its threads worked with the time that passed, in one job of seven: when they
/// worked less than half of it it goes on with half as many, for four times as long as it took to see that,
/// up to twenty times where they wait again and again, and then tries again. So shares of a job must not
/// decide its result: any number of threads from 1 to size() may be given any job.
class ThreadTeam {
 public:
  /// Throws std::system_error if the system gives no more threads, and std::bad_alloc.
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  /// Most threads that a job is given.
  int size() const { return static_cast<int>(members_.size()); }
  /// Number of threads that the next job is given.
  int threads() const { return barrier_.threads_; }
  /// Calls job(t, threads) for t in [0, threads), each on a thread of its own, and returns when all have
  /// returned. What a job throws is thrown here then, of the first of the threads on which it was; jobs that
  /// meet must not throw, or others wait for ever.
  void run(const std::function<void(int, int)>& job);
  /// Where the threads of a job meet; called by thread t of it.
  void meet(int t) { members_[static_cast<std::size_t>(t)].spun += barrier_.meet(); }

 private:
  // So many times as long as a bad stretch took are fewer threads given: at first, since it may be over soon,
  // and once that has doubled with each bad stretch, so that to try again costs 5 % at most. A good stretch
  // takes a tenth off: where good and bad ones alternate, it grows all the same.
  static constexpr double fewer_at_first = 4, fewer_at_last = 20;

  struct alignas(64) Member {
    double worked = 0, spun = 0;  // processor seconds of the job
    std::atomic<std::uint32_t> jobs{0};
    std::exception_ptr thrown;
  };
  void help(int t);
  void work(int t) noexcept;
  void do_share(int t);
  void rethrow();
  void choose_threads(double passed);
  void end();

  Barrier barrier_;
  std::vector<Member> members_;
  const std::function<void(int, int)>* job_ = nullptr;
  std::atomic<int> running_{0};
  std::atomic<bool> over_{false};
  bool looks_ = false;  // the job is one of those whose processor time is measured
  std::uint64_t jobs_run_ = 0;
  // Seconds since the number of threads was chosen: of all jobs, of those looked at, and what threads worked
  // in these.
  double passed_ = 0, looked_ = 0, worked_ = 0;
  double until_ = 0;  // seconds of jobs that fewer threads than all are still given
  double fewer_for_ = fewer_at_first;
  std::vector<std::thread> helpers_;
};

}  // namespace drumlin::particles
