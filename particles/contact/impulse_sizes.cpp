// Compiled once for each instruction set: foreach_target.h includes this file again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "particles/contact/impulse_sizes.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "particles/contact/impulse_sizes.hpp"

HWY_BEFORE_NAMESPACE();
namespace drumlin::particles::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using V = hn::Vec<Doubles>;

HWY_INLINE V size_of(V x, V z, V inverse_mass) {
  const V speed = hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(z, z)));
  return hn::IfThenElseZero(hn::Gt(inverse_mass, hn::Zero(Doubles())), hn::Div(speed, inverse_mass));
}

/// Of the bodies that fill vectors; load(b, x, z, inverse_mass) reads those from b on. Returns how many.
template <class Load>
HWY_INLINE std::size_t sizes_of(std::size_t count, double* sizes, Load load) {
  const Doubles d;
  std::size_t b = 0;
  for (; b + hn::Lanes(d) <= count; b += hn::Lanes(d)) {
    V x, z, inverse_mass;
    load(b, x, z, inverse_mass);
    hn::StoreU(size_of(x, z, inverse_mass), d, sizes + b);
  }
  return b;
}

std::size_t sizes_of_four_floats(const float* records, std::size_t count, double* sizes) {
  const Doubles d;
  return sizes_of(count, sizes, [&](std::size_t b, V& x, V& z, V& inverse_mass) HWY_ATTR {
    const hn::Rebind<float, Doubles> f;
    hn::Vec<decltype(f)> in_x, in_z, s, in_mass;
    hn::LoadInterleaved4(f, records + 4 * b, in_x, in_z, s, in_mass);
    x = hn::PromoteTo(d, in_x), z = hn::PromoteTo(d, in_z), inverse_mass = hn::PromoteTo(d, in_mass);
  });
}

std::size_t sizes_of_four_doubles(const double* records, std::size_t count, double* sizes) {
  return sizes_of(count, sizes, [&](std::size_t b, V& x, V& z, V& inverse_mass) HWY_ATTR {
    V s;
    hn::LoadInterleaved4(Doubles(), records + 4 * b, x, z, s, inverse_mass);
  });
}

std::size_t sizes_of_three_doubles(const double* records, std::size_t count, double* sizes) {
  return sizes_of(count, sizes, [&](std::size_t b, V& x, V& z, V& inverse_mass) HWY_ATTR {
    hn::LoadInterleaved3(Doubles(), records + 3 * b, x, z, inverse_mass);
  });
}

}  // namespace drumlin::particles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace drumlin::particles {

HWY_EXPORT(sizes_of_four_floats);
HWY_EXPORT(sizes_of_four_doubles);
HWY_EXPORT(sizes_of_three_doubles);

std::size_t set_impulse_sizes_of_four(const float* records, std::size_t count, double* sizes) {
  return HWY_DYNAMIC_DISPATCH(sizes_of_four_floats)(records, count, sizes);
}
std::size_t set_impulse_sizes_of_four(const double* records, std::size_t count, double* sizes) {
  return HWY_DYNAMIC_DISPATCH(sizes_of_four_doubles)(records, count, sizes);
}
std::size_t set_impulse_sizes_of_three(const double* records, std::size_t count, double* sizes) {
  return HWY_DYNAMIC_DISPATCH(sizes_of_three_doubles)(records, count, sizes);
}

}  // namespace drumlin::particles
#endif  // HWY_ONCE
