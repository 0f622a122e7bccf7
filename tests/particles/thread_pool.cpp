// Thread pools: every share of a job is done once, whatever the number of threads and their processors.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <new>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "particles/parallel/thread_pool.hpp"

namespace drumlin {
using namespace particles;
namespace {

TEST(ThreadPool, EveryShareOfAJobIsDoneOnceAndThreadsMeet) {
  for (const int size : {1, 2, 3, 8}) {
    ThreadPool pool(size);
    for (long job = 0; job < 300; ++job) {
      std::vector<int> first(static_cast<std::size_t>(size), 0), second = first;
      int threads_of_job = 0;
      pool.run([&](int t, int threads) {
        const auto thread = static_cast<std::size_t>(t);
        if (t == 0) threads_of_job = threads;
        ++first[thread];
        pool.barrier();
        for (int other = 0; other < threads; ++other)
          second[thread] += first[static_cast<std::size_t>(other)];
        pool.barrier();
        first[thread] = 0;
      });
      ASSERT_TRUE(threads_of_job == size || threads_of_job == 1);  // on a busy machine
      for (int t = 0; t < size; ++t) {
        const auto thread = static_cast<std::size_t>(t);
        ASSERT_EQ(second[thread], t < threads_of_job ? threads_of_job : 0);
        ASSERT_EQ(first[thread], 0);
      }
    }
  }
}

/// What the calling thread would destroy on its way out is not destroyed before the others have done their
/// shares.
TEST(ThreadPool, ThrowsWhatAJobThrowsOnceAllAreDone) {
  for (const int size : {1, 2, 4}) {
    ThreadPool pool(size);
    for (int thrower = 0; thrower < size; ++thrower) {
      std::atomic<int> done = 0;
      int threads_of_job = 0;
      try {
        pool.run([&](int t, int threads) {
          if (t == 0) threads_of_job = threads;
          if (t == thrower || t + 1 == threads) throw std::bad_alloc();
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
          ++done;
        });
        FAIL() << size << " threads, " << thrower << " throws";
      } catch (const std::bad_alloc&) {
        const int throwers = thrower + 1 >= threads_of_job ? 1 : 2;
        EXPECT_EQ(done, threads_of_job - throwers);
      }
    }
    int shares = 0;
    pool.run([&](int t, int) { shares += t == 0; });
    EXPECT_EQ(shares, 1);
  }
}

/// In the child a job and the end of the pool wait for nobody; the parent's threads go on.
TEST(ThreadPool, AForkGoesOnAloneWhereTheThreadsAreGone) {
  ThreadPool pool(2);
  std::atomic<int> shares = 0;
  const auto share = [&](int, int) {
    pool.barrier();
    ++shares;
  };
  pool.run(share);
  ASSERT_EQ(shares, 2) << "the first job has all threads";
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(60);  // ends what hangs
    pool.run(share);
    pool.~ThreadPool();
    ::_exit(shares == 3 ? 7 : 8);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 7) << status;
  pool.run(share);
  EXPECT_GE(shares, 3);
}

TEST(Barrier, WakesWhoFallsAsleepJustWhenTheOthersCome) {
  // One thread comes about as late as the other goes to sleep. A wake-up that is lost (one in a million times
  // where the barrier does not order its store before it looks for sleepers) would make this test hang.
  Barrier barrier(2);
  constexpr int rounds = 20000;
  std::thread early([&barrier] {
    for (int round = 0; round < rounds; ++round) barrier.wait();
  });
  using namespace std::chrono;
  for (int round = 0; round < rounds; ++round) {
    const auto late = steady_clock::now() + nanoseconds(32000 + round % 5000);
    while (steady_clock::now() < late) continue;
    barrier.wait();
  }
  early.join();
}

/// Ends this process with 7 if 250 threads in too little memory are an error that says so.
[[noreturn]] void start_too_many() {
  const rlimit room = {1 << 28, 1 << 28};  // bytes: stacks of some threads, not of all
  ::setrlimit(RLIMIT_AS, &room);
  try {
    const ThreadPool pool(250);
  } catch (const std::system_error& error) {
    ::_exit(std::string(error.what()).starts_with("250 threads cannot be started") ? 7 : 8);
  } catch (const std::bad_alloc&) {
    ::_exit(7);
  }
  ::_exit(9);
}

TEST(ThreadPool, ThreadsThatCannotBeStartedAreAnErrorThatTellsHowMany) {
#if defined(__SANITIZE_ADDRESS__)
  // The test limits the addresses of the process, below what the sanitizer has reserved before main().
  GTEST_SKIP() << "the address sanitizer takes terabytes of addresses";
#endif
  EXPECT_EXIT(start_too_many(), ::testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace drumlin
