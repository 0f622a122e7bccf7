#pragma once
// Sums that do not depend on the order of their terms.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

namespace drumlin::particles {

/// A sum of doubles as an integer in fixed point, 448 bits from 2^-288 on: adding is exact (what a term has
/// below 2^-288 is cut off), so that any order, and any number of ranks that add up theirs, gives the same
/// bytes. Limbs hold 32 bits each in 64, so that ranks add them without carries.
class ExactSum {
 public:
  void add(double term);
  /// Adds term(0), ..., term(count - 1), none of them negative: faster than one by one where they are of like
  /// size. A negative one counts as no number.
  template <class Term>
  void add_terms(std::size_t count, Term term);
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
  __extension__ using Wide = unsigned __int128;  // of g++ and Clang
  /// A number of so many times the lowest place.
  struct Digits {
    std::uint64_t digits = 0;
    int place = 0;
  };
  /// Of a term from 0 to below 2^128; no digits where all are below the lowest place.
  static Digits digits_of(double term);
  /// Adds a number from a limb on, as one term.
  void add_from(int limb, Wide number);

  std::array<std::int64_t, limbs + 1> numbers_{};  // the last counts terms that are no numbers
  std::int64_t terms_ = 0;                         // since the last carry
};

inline ExactSum::Digits ExactSum::digits_of(double term) {
  // term = digits 2^(power - 1075), of normal numbers; others are below the lowest place.
  const auto bits = std::bit_cast<std::uint64_t>(term);
  const auto power = static_cast<int>(bits >> 52);
  const std::uint64_t digits = (bits & ((std::uint64_t{1} << 52) - 1)) | (std::uint64_t{1} << 52);
  const int place = power - 1075 - lowest;
  if (place >= 0) return {digits, place};
  return {place <= -53 ? 0 : digits >> -place, 0};
}

inline void ExactSum::add(double term) {
  if (term == 0) return;
  if (!(std::abs(term) < 0x1p128)) {
    ++numbers_[limbs];
    return;
  }
  constexpr std::uint64_t low_bits = 0xffffffffu;
  const auto [digits, place] = digits_of(std::abs(term));
  const int limb = place / 32, shift = place % 32;
  const std::uint64_t low = (digits & low_bits) << shift, high = (digits >> 32) << shift;
  const std::int64_t sign = term < 0 ? -1 : 1;
  numbers_[limb] += sign * static_cast<std::int64_t>(low & low_bits);
  numbers_[limb + 1] += sign * static_cast<std::int64_t>((low >> 32) + (high & low_bits));
  numbers_[limb + 2] += sign * static_cast<std::int64_t>(high >> 32);
  if (++terms_ >= most_terms) carry();
}

template <class Term>
void ExactSum::add_terms(std::size_t count, Term term) {
  // 53 digits so much further on, of so many terms, stay within 128 bits.
  constexpr int most_shift = 63;
  constexpr std::size_t most_at_once = 1 << 11;
  for (std::size_t begin = 0; begin < count; begin += most_at_once) {
    const std::size_t end = std::min(count, begin + most_at_once);
    Wide sum = 0;
    int limb = 0;  // where `sum` begins
    for (std::size_t k = begin; k < end; ++k) {
      const double t = term(k);
      if (!(t >= 0 && t < 0x1p128)) {
        ++numbers_[limbs];
        continue;
      }
      const auto [digits, place] = digits_of(std::abs(t));  // of -0, too
      if (const int shift = place - 32 * limb; shift < 0 || shift > most_shift) {
        if (digits == 0) continue;
        add_from(limb, std::exchange(sum, 0));
        limb = std::max(0, place / 32 - 1);  // room for smaller ones
      }
      sum += static_cast<Wide>(digits) << (place - 32 * limb);
    }
    add_from(limb, sum);
  }
}

}  // namespace drumlin::particles
