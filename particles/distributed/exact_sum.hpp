#pragma once
// Sums that do not depend on the order of their terms.
#include <array>
#include <cstdint>
#include <span>

namespace drumlin::particles {

/// A sum of doubles as an integer in fixed point, 448 bits from 2^-288 on: adding is exact (what a term has
/// below 2^-288 is cut off), so that any order, and any number of ranks that add up theirs, gives the same
/// bytes. Limbs hold 32 bits each in 64, so that ranks add them without carries.
class ExactSum {
 public:
  void add(double term);
  void add(const ExactSum& more);
  /// The sum, rounded; NaN where a term was not finite or beyond 2^128.
  double value() const;
  /// What ranks add up, entry by entry.
  std::span<std::int64_t> numbers() { return numbers_; }
  static constexpr std::size_t size() { return limbs + 1; }

 private:
  static constexpr int limbs = 14, lowest = -288;
  void carry();

  std::array<std::int64_t, limbs + 1> numbers_{};  // the last counts terms that are no numbers
  std::int64_t terms_ = 0;                         // since the last carry
};

}  // namespace drumlin::particles
