#pragma once
// The processes (ranks) that share a run, and what they tell each other. MPI is seen in the .cpp files of
// this room alone.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "particles/distributed/exact_sum.hpp"

namespace drumlin::particles {

/// Keeps MPI alive while it lives: made first thing in main.
class RankRuntime {
 public:
  RankRuntime(int& argc, char**& argv);
  ~RankRuntime();
  RankRuntime(const RankRuntime&) = delete;
  RankRuntime& operator=(const RankRuntime&) = delete;

 private:
  struct Libraries;
  std::unique_ptr<Libraries> libraries_;
};

/// All ranks of the program. Every member is called by all of them together; results that steer a run are
/// independent of their number: maxima, and sums of integers.
class Ranks {
 public:
  /// Bytes of a file, from a place on.
  struct FilePiece {
    std::uint64_t place = 0;
    std::span<const std::byte> bytes;
  };

  int rank() const;
  int count() const;

  /// Sends to_rank[r] to each rank r; returns what each rank sent here.
  template <class T>
  std::vector<std::vector<T>> exchange(const std::vector<std::vector<T>>& to_rank) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<std::vector<std::byte>> bytes(to_rank.size());
    for (std::size_t r = 0; r < to_rank.size(); ++r) {
      const auto own = std::as_bytes(std::span(to_rank[r]));
      bytes[r].assign(own.begin(), own.end());
    }
    std::vector<std::vector<T>> received(bytes.size());
    const auto arrived = exchange_bytes(bytes);
    for (std::size_t r = 0; r < arrived.size(); ++r) received[r] = as<T>(arrived[r]);
    return received;
  }
  /// What all ranks give, in the order of the ranks: on one of them; empty on the others.
  template <class T>
  std::vector<T> gather(std::span<const T> own, int on = 0) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> all;  // may be large: no copy of it
    gather_bytes(std::as_bytes(own), on, [&all](std::size_t bytes) {
      all.resize(bytes / sizeof(T));
      return std::as_writable_bytes(std::span(all)).data();
    });
    return all;
  }
  /// The same, on all ranks.
  template <class T>
  std::vector<T> gather_everywhere(std::span<const T> own) const {
    std::vector<T> all = gather(own);
    broadcast(all);
    return all;
  }
  /// Replaces the values of all ranks by those of one.
  template <class T>
  void broadcast(std::vector<T>& values, int from = 0) const {
    static_assert(std::is_trivially_copyable_v<T>);
    values.resize(broadcast_count(values.size(), from));
    broadcast_bytes(std::as_writable_bytes(std::span(values)), from);
  }

  /// Each value becomes the largest of all ranks. No NaN.
  void largest(std::span<double> values) const;
  /// Each value becomes the sum over all ranks.
  void add(std::span<std::int64_t> values) const;
  /// The same of exact sums, and of a count, in one round; returns the latter.
  std::int64_t add(std::span<ExactSum> sums, std::int64_t count = 0) const;
  /// The least of all ranks.
  std::int64_t least(std::int64_t value) const;
  bool any(bool value) const;

  /// What one rank has to do for all: files and messages. What `action` throws there is thrown there, and
  /// FailedOnFirstRank on the others.
  void on_first(const std::function<void()>& action) const;
  /// Throws on all ranks where `text` is not the same on all (require_same_on_ranks).
  void require_same(const std::string& text, const std::string& what) const;
  /// Writes pieces into a file that stands, each rank its own (MPI-IO), and forces them to the disk. Returns,
  /// on all ranks, which one could not and why; empty where all could.
  std::string write_pieces(const std::filesystem::path& file, std::span<const FilePiece> pieces) const;
  /// Messages and pieces of files go in parts of so many bytes, 2^30 unless told, which no result shows. All
  /// ranks have to say the same.
  static void cut_messages(std::size_t bytes);
  /// Ends all ranks at once with an exit code: for an error that one rank meets alone.
  [[noreturn]] static void end_all(int exit_code);

  /// Rounds of messages between all ranks so far: what a run costs where latency counts.
  static std::int64_t rounds();
  /// Processor time that this rank has spent in them, most of it waiting for others.
  static double waiting_seconds();

 private:
  template <class T>
  static std::vector<T> as(const std::vector<std::byte>& bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    const auto to = std::as_writable_bytes(std::span(values));
    std::copy_n(bytes.begin(), to.size(), to.begin());
    return values;
  }
  std::vector<std::vector<std::byte>> exchange_bytes(const std::vector<std::vector<std::byte>>&) const;
  /// `place_for` so many bytes is asked for there alone.
  void gather_bytes(std::span<const std::byte>, int on,
                    const std::function<std::byte*(std::size_t)>& place_for) const;
  std::size_t broadcast_count(std::size_t count, int from) const;
  void broadcast_bytes(std::span<std::byte>, int from) const;
};

}  // namespace drumlin::particles
