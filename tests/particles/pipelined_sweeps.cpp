// Waves of sweeps: the result of sweeps in turn, for any number of strips and threads.
#include "particles/solver/pipelined_sweeps.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "particles/parallel/thread_pool.hpp"

namespace drumlin {
using namespace particles;
namespace {

/// Strips of two slices each, shared by numbers.
struct Strips {
  int count = 0;
  int own_rank = 0, all_ranks = 1;
  int strips() const { return count; }
  int rank() const { return own_rank; }
  int ranks() const { return all_ranks; }
  int first_strip(int rank, int thread, int threads) const {
    const int begin = count * rank / all_ranks, end = count * (rank + 1) / all_ranks;
    return begin + (end - begin) * thread / threads;
  }
};

/// What phases make of the slices; whoever comes too early or too late makes something else.
class Slices {
 public:
  explicit Slices(int strips) : slices_(2 * static_cast<std::size_t>(strips) + 1) {
    for (std::size_t k = 0; k < slices_.size(); ++k) slices_[k] = k;
  }
  void touch(int sweep, int strip, int phase) {
    const std::size_t slice = 2 * static_cast<std::size_t>(strip) + static_cast<std::size_t>(phase);
    std::uint64_t &a = slices_[slice], &b = slices_[slice + 1];
    a = 6364136223846793005U * (a ^ (b << 1U)) + static_cast<std::uint64_t>(sweep) + 1;
    b = 2862933555777941757U * (b ^ (a >> 3U)) + slice;
  }
  const std::vector<std::uint64_t>& numbers() const { return slices_; }

 private:
  std::vector<std::uint64_t> slices_;
};

std::vector<std::uint64_t> in_turn(int strips, int sweeps) {
  Slices slices(strips);
  for (int s = 0; s < sweeps; ++s)
    for (const int phase : {0, 1})
      for (int strip = 0; strip < strips; ++strip) slices.touch(s, strip, phase);
  return slices.numbers();
}

TEST(SweepWave, GivesWhatSweepsInTurnGive) {
  for (const int size : {1, 2, 3, 5}) {
    ThreadPool pool(size);
    for (const int strips : {1, 2, 3, 7, 12, 20, 21, 33, 64})
      for (int sweeps = 1; sweeps <= longest_pipeline; ++sweeps) {
        Slices slices(strips);
        pool.run([&](int t, int threads) {
          pipelined_sweeps(
              share_of(Strips{strips}, t, threads, size), sweeps,
              [&](int s, int strip, int phase) { slices.touch(s, strip, phase); }, [&](int) { pool.barrier(); });
        });
        EXPECT_EQ(slices.numbers(), in_turn(strips, sweeps))
            << size << " threads, " << strips << " strips, " << sweeps << " sweeps";
      }
  }
}

/// Threads stand for ranks here.
TEST(SweepWave, OfSeveralRanksIsTheSame) {
  constexpr int ranks = 3, threads = 2, strips = 64;
  for (int sweeps = 1; sweeps <= longest_pipeline; ++sweeps) {
    ThreadPool pool(ranks * threads);
    Slices slices(strips);
    pool.run([&](int t, int) {
      pipelined_sweeps(
          share_of(Strips{strips, t / threads, ranks}, t % threads, threads, threads), sweeps,
          [&](int s, int strip, int phase) { slices.touch(s, strip, phase); }, [&](int) { pool.barrier(); });
    });
    EXPECT_EQ(slices.numbers(), in_turn(strips, sweeps)) << sweeps << " sweeps";
  }
}

/// As of a rank beyond those that share the strips.
TEST(SweepWave, OfNoStripsOnlyMeets) {
  int meetings = 0;
  const StripShare none{64, 64, 20, true, false};
  pipelined_sweeps(
      none, 5, [](int, int strip, int) { FAIL() << strip; }, [&](int) { ++meetings; });
  EXPECT_EQ(meetings, 10);
}

}  // namespace
}  // namespace drumlin
