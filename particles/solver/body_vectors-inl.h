// Vectors of bodies: records of several bodies loaded as one vector for each of their numbers, and stored
// back. Included once for each instruction set.
#if defined(DRUMLIN_BODY_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DRUMLIN_BODY_VECTORS_INL_H
#undef DRUMLIN_BODY_VECTORS_INL_H
#else
#define DRUMLIN_BODY_VECTORS_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <type_traits>

#include "particles/solver/sweep_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace drumlin::particles::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Four numbers of a body are 256 bits in double precision: longer vectors would only add permutations.
template <class T>
using Lanes = hn::CappedTag<T, 32 / sizeof(T)>;

template <class T>
struct BodyVectors {
  hn::Vec<Lanes<T>> x, z, s, inverse_mass;
};

/// The record that begins so many bytes after the first one.
template <class Record>
HWY_INLINE Record& record(Record* bodies, std::uint32_t place) {
  using Byte = std::conditional_t<std::is_const_v<Record>, const std::byte, std::byte>;
  return *reinterpret_cast<Record*>(reinterpret_cast<Byte*>(bodies) + place);
}

#if HWY_TARGET == HWY_SCALAR

// A processor without vectors, or one that Highway does not know.
template <class T>
HWY_INLINE BodyVectors<T> load_bodies(const BodyRecord<T>* bodies, const std::uint32_t* places) {
  const Lanes<T> d;
  const BodyRecord<T>& b = record(bodies, places[0]);
  return {hn::Load(d, &b.x), hn::Load(d, &b.z), hn::Load(d, &b.s), hn::Load(d, &b.inverse_mass)};
}
template <class T>
HWY_INLINE void store_bodies(const BodyVectors<T>& v, BodyRecord<T>* bodies, const std::uint32_t* places) {
  const Lanes<T> d;
  BodyRecord<T>& b = record(bodies, places[0]);
  hn::Store(v.x, d, &b.x), hn::Store(v.z, d, &b.z), hn::Store(v.s, d, &b.s);
}

#else

/// Four records become four vectors, and back: the transposition is its own inverse within 4 x 4 blocks.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void transpose_doubles(D d, V a, V b, V c, V e, V& x, V& z, V& s, V& m) {
  const V low_ab = hn::InterleaveLower(d, a, b), high_ab = hn::InterleaveUpper(d, a, b);
  const V low_ce = hn::InterleaveLower(d, c, e), high_ce = hn::InterleaveUpper(d, c, e);
  x = hn::ConcatLowerLower(d, low_ce, low_ab);
  z = hn::ConcatLowerLower(d, high_ce, high_ab);
  s = hn::ConcatUpperUpper(d, low_ce, low_ab);
  m = hn::ConcatUpperUpper(d, high_ce, high_ab);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void transpose_floats(D d, V a, V b, V c, V e, V& x, V& z, V& s, V& m) {
  const hn::Repartition<double, D> wide;
  const auto low_ab = hn::BitCast(wide, hn::InterleaveLower(d, a, b));
  const auto high_ab = hn::BitCast(wide, hn::InterleaveUpper(d, a, b));
  const auto low_ce = hn::BitCast(wide, hn::InterleaveLower(d, c, e));
  const auto high_ce = hn::BitCast(wide, hn::InterleaveUpper(d, c, e));
  x = hn::BitCast(d, hn::InterleaveLower(wide, low_ab, low_ce));
  z = hn::BitCast(d, hn::InterleaveUpper(wide, low_ab, low_ce));
  s = hn::BitCast(d, hn::InterleaveLower(wide, high_ab, high_ce));
  m = hn::BitCast(d, hn::InterleaveUpper(wide, high_ab, high_ce));
}

HWY_INLINE BodyVectors<double> load_bodies(const BodyRecord<double>* bodies, const std::uint32_t* places) {
  const Lanes<double> d;
  BodyVectors<double> v;
#if HWY_TARGET <= HWY_AVX2
  transpose_doubles(d, hn::Load(d, &record(bodies, places[0]).x), hn::Load(d, &record(bodies, places[1]).x),
                    hn::Load(d, &record(bodies, places[2]).x), hn::Load(d, &record(bodies, places[3]).x), v.x,
                    v.z, v.s, v.inverse_mass);
#else
  const auto a = hn::Load(d, &record(bodies, places[0]).x), b = hn::Load(d, &record(bodies, places[1]).x);
  const auto c = hn::Load(d, &record(bodies, places[0]).s), e = hn::Load(d, &record(bodies, places[1]).s);
  v.x = hn::InterleaveLower(d, a, b), v.z = hn::InterleaveUpper(d, a, b);
  v.s = hn::InterleaveLower(d, c, e), v.inverse_mass = hn::InterleaveUpper(d, c, e);
#endif
  return v;
}

HWY_INLINE void store_bodies(const BodyVectors<double>& v, BodyRecord<double>* bodies,
                             const std::uint32_t* places) {
  const Lanes<double> d;
#if HWY_TARGET <= HWY_AVX2
  hn::Vec<Lanes<double>> a, b, c, e;
  transpose_doubles(d, v.x, v.z, v.s, v.inverse_mass, a, b, c, e);
  hn::Store(a, d, &record(bodies, places[0]).x);
  hn::Store(b, d, &record(bodies, places[1]).x);
  hn::Store(c, d, &record(bodies, places[2]).x);
  hn::Store(e, d, &record(bodies, places[3]).x);
#else
  hn::Store(hn::InterleaveLower(d, v.x, v.z), d, &record(bodies, places[0]).x);
  hn::Store(hn::InterleaveLower(d, v.s, v.inverse_mass), d, &record(bodies, places[0]).s);
  hn::Store(hn::InterleaveUpper(d, v.x, v.z), d, &record(bodies, places[1]).x);
  hn::Store(hn::InterleaveUpper(d, v.s, v.inverse_mass), d, &record(bodies, places[1]).s);
#endif
}

HWY_INLINE BodyVectors<float> load_bodies(const BodyRecord<float>* bodies, const std::uint32_t* places) {
  const Lanes<float> d;
  BodyVectors<float> v;
#if HWY_TARGET <= HWY_AVX2
  const hn::Half<Lanes<float>> half;
  const auto pair = [&](int k) HWY_ATTR {
    return hn::Combine(d, hn::Load(half, &record(bodies, places[k + 4]).x),
                       hn::Load(half, &record(bodies, places[k]).x));
  };
  transpose_floats(d, pair(0), pair(1), pair(2), pair(3), v.x, v.z, v.s, v.inverse_mass);
#else
  transpose_floats(d, hn::Load(d, &record(bodies, places[0]).x), hn::Load(d, &record(bodies, places[1]).x),
                   hn::Load(d, &record(bodies, places[2]).x), hn::Load(d, &record(bodies, places[3]).x), v.x,
                   v.z, v.s, v.inverse_mass);
#endif
  return v;
}

HWY_INLINE void store_bodies(const BodyVectors<float>& v, BodyRecord<float>* bodies,
                             const std::uint32_t* places) {
  const Lanes<float> d;
  hn::Vec<Lanes<float>> a, b, c, e;
  transpose_floats(d, v.x, v.z, v.s, v.inverse_mass, a, b, c, e);
#if HWY_TARGET <= HWY_AVX2
  const hn::Half<Lanes<float>> half;
  const auto store = [&](hn::Vec<Lanes<float>> pair, int k) HWY_ATTR {
    hn::Store(hn::LowerHalf(half, pair), half, &record(bodies, places[k]).x);
    hn::Store(hn::UpperHalf(half, pair), half, &record(bodies, places[k + 4]).x);
  };
  store(a, 0), store(b, 1), store(c, 2), store(e, 3);
#else
  hn::Store(a, d, &record(bodies, places[0]).x);
  hn::Store(b, d, &record(bodies, places[1]).x);
  hn::Store(c, d, &record(bodies, places[2]).x);
  hn::Store(e, d, &record(bodies, places[3]).x);
#endif
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace drumlin::particles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
