#include "particles/distributed/exact_sum.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace drumlin::particles {
namespace {

constexpr std::int64_t base = std::int64_t{1} << 32;
constexpr std::uint64_t low_bits = 0xffffffffu;
// A limb takes 2^30 terms, of less than 2^33 each; half of that is left to what ranks add.
constexpr std::int64_t most_terms = std::int64_t{1} << 28;

}  // namespace

void ExactSum::add(double term) {
  if (term == 0) return;
  if (!(std::abs(term) < 0x1p128)) {
    ++numbers_[limbs];
    return;
  }
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

void ExactSum::add(const ExactSum& more) {
  ExactSum other = more;
  other.carry();
  carry();
  for (std::size_t k = 0; k < numbers_.size(); ++k) numbers_[k] += other.numbers_[k];
}

/// All limbs but the highest come to lie in [0, 2^32).
void ExactSum::carry() {
  for (int k = 0; k + 1 < limbs; ++k) {
    std::int64_t carried = numbers_[k] / base;
    if (numbers_[k] % base < 0) --carried;
    numbers_[k] -= carried * base;
    numbers_[k + 1] += carried;
  }
  terms_ = 0;
}

double ExactSum::value() const {
  if (numbers_[limbs] != 0) return std::numeric_limits<double>::quiet_NaN();
  ExactSum sum = *this;
  sum.carry();
  const bool negative = sum.numbers_[limbs - 1] < 0;
  if (negative) {
    for (int k = 0; k < limbs; ++k) sum.numbers_[k] = -sum.numbers_[k];
    sum.carry();
  }
  double value = 0;
  for (int k = limbs - 1; k >= 0; --k)
    value += std::ldexp(static_cast<double>(sum.numbers_[k]), 32 * k + lowest);
  return negative ? -value : value;
}

}  // namespace drumlin::particles
