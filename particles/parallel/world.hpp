#pragma once
// The processes that take the steps of one run together (docs/decisions.md).
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

namespace drumlin::particles {

/// Ranks of a run. Each holds the whole state and does a share of the work of a step, so that the state stays
/// the same on all. Every member is called by all of them together. A run on one process has none of it.
class World {
 public:
  virtual ~World() = default;
  virtual int rank() const = 0;
  virtual int ranks() const = 0;
  /// Wall time that this rank has spent in messages, most of it waiting for others.
  virtual double waiting_seconds() const = 0;

  /// Gives all ranks the whole of an array of which rank r has computed the entries first[r] to
  /// first[r + 1] - 1.
  template <class T>
  void gather(std::span<T> all, std::span<const std::size_t> first) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<std::size_t> bytes(first.begin(), first.end());
    for (std::size_t& b : bytes) b *= sizeof(T);
    gather_bytes(std::as_writable_bytes(all).data(), bytes);
  }
  /// Sends entries to rank `to` and receives others from rank `from`; -1: there is none.
  template <class T>
  void pass(std::span<const T> sent, int to, std::span<T> received, int from) {
    static_assert(std::is_trivially_copyable_v<T>);
    pass_bytes(std::as_bytes(sent), to, std::as_writable_bytes(received), from);
  }
  /// Gives all ranks what the first one has.
  template <class T>
  T of_first(T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_of_first(std::as_writable_bytes(std::span(&value, 1)));
    return value;
  }
  virtual void bytes_of_first(std::span<std::byte> bytes) = 0;
  /// Gives all ranks what each has.
  template <class T>
  std::vector<T> of_each(T value) {
    std::vector<T> all(ranks(), value);
    std::vector<std::size_t> first;
    for (int r = 0; r <= ranks(); ++r) first.push_back(r);
    gather(std::span(all), std::span<const std::size_t>(first));
    return all;
  }
  /// Whether ranks are in the middle of a step: one that leaves it alone has to end all.
  bool in_step = false;
  /// Ends all ranks at once with an exit code: for an error that one of them meets alone.
  [[noreturn]] virtual void end_all(int exit_code) = 0;

 private:
  virtual void gather_bytes(std::byte* all, std::span<const std::size_t> first) = 0;
  virtual void pass_bytes(std::span<const std::byte> sent, int to, std::span<std::byte> received,
                          int from) = 0;
};

}  // namespace drumlin::particles
