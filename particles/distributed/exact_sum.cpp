#include "particles/distributed/exact_sum.hpp"

#include <cmath>
#include <limits>

namespace drumlin::particles {
namespace {

constexpr std::int64_t base = std::int64_t{1} << 32;

}  // namespace

void ExactSum::add(const ExactSum& more) {
  ExactSum other = more;
  other.carry();
  carry();
  for (std::size_t k = 0; k < numbers_.size(); ++k) numbers_[k] += other.numbers_[k];
}

void ExactSum::add_from(int limb, Wide number) {
  for (; number != 0; number >>= 32, ++limb)
    numbers_[limb] += static_cast<std::int64_t>(static_cast<std::uint32_t>(number));
  if (++terms_ >= most_terms) carry();
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
