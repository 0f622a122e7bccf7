// The laws of contacts on vectors, a contact in each lane. Without a guard: those who include this do so once
// for each instruction set.
#include <hwy/highway.h>

#include <array>
#include <cstddef>

#include "particles/contact_law/contact_laws-inl.h"

HWY_BEFORE_NAMESPACE();
namespace drumlin::particles::HWY_NAMESPACE::contact_law {

namespace hn = hwy::HWY_NAMESPACE;

// Operations of the laws, as those on numbers (laws.hpp).
template <class V>
HWY_INLINE V number(double value) {
  const hn::DFromV<V> d;
  return hn::Set(d, static_cast<hn::TFromD<decltype(d)>>(value));
}
template <class M, class V>
HWY_INLINE bool any(M mask, V) {
  return !hn::AllFalse(hn::DFromV<V>(), mask);
}
template <class M>
HWY_INLINE M both(M a, M b) {
  return hn::And(a, b);
}
template <class M>
HWY_INLINE M either(M a, M b) {
  return hn::Or(a, b);
}
template <class V>
HWY_INLINE auto greater(V a, V b) {
  return hn::Gt(a, b);
}
template <class V>
HWY_INLINE auto not_less(V a, V b) {
  return hn::Ge(a, b);
}
template <class V>
HWY_INLINE auto not_greater(V a, V b) {
  return hn::Le(a, b);
}
template <class M, class V>
HWY_INLINE V where(M mask, V a, V b) {
  return hn::IfThenElse(mask, a, b);
}
template <class V>
HWY_INLINE V absolute(V a) {
  return hn::Abs(a);
}
template <class V>
HWY_INLINE V square_root(V a) {
  return hn::Sqrt(a);
}
template <class V>
HWY_INLINE V with_sign_of(V size, V sign) {
  return hn::CopySign(size, sign);
}
template <class V>
HWY_INLINE V larger(V a, V b) {
#if HWY_TARGET == HWY_SCALAR
  return hn::IfThenElse(hn::Le(b, a), a, b);
#else
  return hn::Max(a, b);  // a NaN of b on these processors
#endif
}
template <class V>
HWY_INLINE V smaller(V a, V b) {
  return hn::Min(a, b);
}
template <class V>
HWY_INLINE V positive_part(V a) {
  return larger(number<V>(0), a);
}
template <class V>
HWY_INLINE V clamped(V a, V bound) {
  return hn::Min(bound, hn::Max(hn::Neg(bound), a));
}

#define CONTACT_LAW HWY_INLINE
#include "particles/contact_law/law_text-inl.h"
#undef CONTACT_LAW

}  // namespace drumlin::particles::HWY_NAMESPACE::contact_law
HWY_AFTER_NAMESPACE();
