#pragma once
// Loops over many entries, shared among the threads of a pool.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "particles/parallel/thread_pool.hpp"

namespace drumlin::particles {

/// Cuts loops into pieces that do not depend on the number of threads: sums over pieces, added in their
/// order, are the same bytes for any pool.
class ParallelLoops {
 public:
  /// No pool: the calling thread does everything.
  explicit ParallelLoops(ThreadPool* pool = nullptr) : pool_(pool) {}

  /// Calls work(begin, end) for pieces of [0, count).
  template <class Work>
  void each(std::size_t count, Work work) const {
    const std::size_t pieces = (count + piece - 1) / piece;
    const auto some = [&](std::size_t first, std::size_t last) {
      for (std::size_t p = first; p < last; ++p) work(p * piece, std::min(count, (p + 1) * piece));
    };
    if (pool_ == nullptr || pieces < 4) return some(0, pieces);
    pool_->run([&](int t, int count_of_threads) {
      const auto thread = static_cast<std::size_t>(t), threads = static_cast<std::size_t>(count_of_threads);
      some(pieces * thread / threads, pieces * (thread + 1) / threads);
    });
  }

  /// Calls work(k) for k in [0, count), each a large piece of work.
  template <class Work>
  void each_of(int count, Work work) const {
    const auto some = [&](int first, int last) {
      for (int k = first; k < last; ++k) work(k);
    };
    if (pool_ == nullptr || count < 2) return some(0, count);
    pool_->run([&](int t, int threads) { some(count * t / threads, count * (t + 1) / threads); });
  }

  /// The sum of part(begin, end) over the pieces.
  template <class Part>
  double sum(std::size_t count, Part part) {
    parts_.assign((count + piece - 1) / piece, 0.0);
    each(count, [&](std::size_t begin, std::size_t end) { parts_[begin / piece] = part(begin, end); });
    double total = 0;
    for (const double p : parts_) total += p;
    return total;
  }

  /// The sums part(begin, end) over the pieces, added up in their order by Sums::add.
  template <class Sums, class Part>
  Sums combined(std::size_t count, Part part) const {
    std::vector<Sums> parts((count + piece - 1) / piece);
    each(count, [&](std::size_t begin, std::size_t end) { parts[begin / piece] = part(begin, end); });
    Sums all;
    for (const Sums& own : parts) all.add(own);
    return all;
  }

  ThreadPool* pool() const { return pool_; }
  /// That the next loop is given.
  int threads() const { return pool_ ? pool_->threads() : 1; }

 private:
  static constexpr std::size_t piece = 1024;
  ThreadPool* pool_;
  std::vector<double> parts_;
};

}  // namespace drumlin::particles
