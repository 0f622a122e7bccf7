// Compiled once for each instruction set: foreach_target.h includes this file again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "particles/detection/pair_weights.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "particles/detection/pair_weights.hpp"

HWY_BEFORE_NAMESPACE();
namespace drumlin::particles::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET <= HWY_AVX2

using Four = hn::CappedTag<double, 4>;
using V = hn::Vec<Four>;

/// Four records become four vectors, and back.
HWY_INLINE void transpose(V& a, V& b, V& c, V& e) {
  const Four d;
  const V low_ab = hn::InterleaveLower(d, a, b), high_ab = hn::InterleaveUpper(d, a, b);
  const V low_ce = hn::InterleaveLower(d, c, e), high_ce = hn::InterleaveUpper(d, c, e);
  a = hn::ConcatLowerLower(d, low_ce, low_ab);
  b = hn::ConcatLowerLower(d, high_ce, high_ab);
  c = hn::ConcatUpperUpper(d, low_ce, low_ab);
  e = hn::ConcatUpperUpper(d, high_ce, high_ab);
}

std::size_t weigh_fours(std::span<const ListedPair> pairs, const MovingDisc* discs, const double* radius,
                        double twice_step, PairWeight* weights) {
  const Four d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0), half = hn::Set(d, 0.5), twice = hn::Set(d, twice_step);
  std::size_t k = 0;
  for (; k + 4 <= pairs.size(); k += 4) {
    const auto difference = [&](const ListedPair& pair) HWY_ATTR {
      return hn::Sub(hn::Load(d, &discs[pair.i].x), hn::Load(d, &discs[pair.j].x));
    };
    V x = difference(pairs[k]), z = difference(pairs[k + 1]), u_x = difference(pairs[k + 2]),
      u_z = difference(pairs[k + 3]);
    transpose(x, z, u_x, u_z);
    HWY_ALIGN double radii[4];
    for (std::size_t p = 0; p < 4; ++p) radii[p] = radius[pairs[k + p].i] + radius[pairs[k + p].j];
    const V apart = hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(z, z)));
    const V same_place = hn::IfThenElse(hn::Gt(apart, zero), zero, one);
    const V inverse = hn::Div(one, hn::Add(apart, same_place));
    V n_x = hn::Mul(x, inverse), n_z = hn::Add(hn::Mul(z, inverse), same_place);
    const V approach = hn::Neg(hn::Add(hn::Mul(n_x, u_x), hn::Mul(n_z, u_z)));
    V gap = hn::Sub(apart, hn::Load(d, radii));
    V reach = hn::Mul(twice, hn::Mul(hn::Add(approach, hn::Abs(approach)), half));
    transpose(gap, n_x, n_z, reach);
    hn::Store(gap, d, &weights[k].gap);
    hn::Store(n_x, d, &weights[k + 1].gap);
    hn::Store(n_z, d, &weights[k + 2].gap);
    hn::Store(reach, d, &weights[k + 3].gap);
  }
  return k;
}

#else

std::size_t weigh_fours(std::span<const ListedPair>, const MovingDisc*, const double*, double, PairWeight*) {
  return 0;
}

#endif

}  // namespace drumlin::particles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace drumlin::particles {

HWY_EXPORT(weigh_fours);

std::size_t weigh_on_vectors(std::span<const ListedPair> pairs, const MovingDisc* discs, const double* radius,
                             double twice_step, PairWeight* weights) {
  return HWY_DYNAMIC_DISPATCH(weigh_fours)(pairs, discs, radius, twice_step, weights);
}

}  // namespace drumlin::particles
#endif  // HWY_ONCE
