#pragma once
// Sums that do not depend on the order of their terms.
#include <array>
#include <bit>
#include <cmath>
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
  // A limb takes 2^30 terms, of less than 2^33 each; half of that is left to what ranks add.
  static constexpr std::int64_t most_terms = std::int64_t{1} << 28;
  void carry();

  std::array<std::int64_t, limbs + 1> numbers_{};  // the last counts terms that are no numbers
  std::int64_t terms_ = 0;                         // since the last carry
};

inline void ExactSum::add(double term) {
  if (term == 0) return;
  if (!(std::abs(term) < 0x1p128)) {
    ++numbers_[limbs];
    return;
  }
  constexpr std::uint64_t low_bits = 0xffffffffu;
  // term = digits 2^(power - 1075), of normal numbers; others are below the lowest place.
  const auto bits = std::bit_cast<std::uint64_t>(std::abs(term));
  const auto power = static_cast<int>(bits >> 52);
  std::uint64_t digits = (bits & ((std::uint64_t{1} << 52) - 1)) | (std::uint64_t{1} << 52);
  int place = power - 1075 - lowest;
  if (place < 0) {
    if (place <= -53) return;
    digits >>= -place, place = 0;
  }
  const int limb = place / 32, shift = place % 32;
  const std::uint64_t low = (digits & low_bits) << shift, high = (digits >> 32) << shift;
  const std::int64_t sign = term < 0 ? -1 : 1;
  numbers_[limb] += sign * static_cast<std::int64_t>(low & low_bits);
  numbers_[limb + 1] += sign * static_cast<std::int64_t>((low >> 32) + (high & low_bits));
  numbers_[limb + 2] += sign * static_cast<std::int64_t>(high >> 32);
  if (++terms_ >= most_terms) carry();
}

}  // namespace drumlin::particles
