// Vectors of impulses and the cones of their contacts (particles/contact/cone.hpp). Without a guard: those
// who include this do so once for each instruction set.
#include <hwy/highway.h>

#include "particles/contact/cone.hpp"

HWY_BEFORE_NAMESPACE();
namespace drumlin::particles::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class V>
HWY_INLINE V clamped(V value, V bound) {
  return hn::Min(bound, hn::Max(hn::Neg(bound), value));
}

/// max(0, value), of no number itself: hn::Max forgets that on some processors.
template <class V>
HWY_INLINE V positive_part(V value) {
  const V zero = hn::Zero(hn::DFromV<V>());
  return hn::IfThenElse(hn::Lt(value, zero), zero, value);
}

/// Whether any of these coefficients is above steep_friction.
template <class V>
HWY_INLINE bool any_steep(V mu) {
  const hn::DFromV<V> d;
  return !hn::AllFalse(d, hn::Gt(mu, hn::Set(d, steep_friction)));
}

/// share_of_way() of contacts.
template <class V>
HWY_INLINE V share_of_way(V mu, V n, V t, V whole, V free) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1), zero = hn::Zero(d);
  const V on_bound = hn::Mul(hn::Set(d, 0.999), hn::Mul(mu, n));
  const auto slides = hn::And(hn::Gt(n, zero), hn::Ge(hn::Abs(t), on_bound));
  const auto will_slide = hn::Ge(hn::Abs(free), hn::Mul(mu, whole));
  const auto slow = hn::And(hn::Gt(mu, hn::Set(d, steep_friction)), hn::Or(slides, will_slide));
  return hn::IfThenElse(slow, hn::Div(one, mu), one);
}

/// Squared distance of (r_n, r_t) from n, at least 0, and t, clamped to mu n.
template <class V>
HWY_INLINE V missed_in_turn(V mu, V n, V t, V r_n, V r_t) {
  const V above = positive_part(n);
  const V missed_n = hn::Sub(above, r_n), missed_t = hn::Sub(clamped(t, hn::Mul(mu, above)), r_t);
  return hn::Add(hn::Mul(missed_n, missed_n), hn::Mul(missed_t, missed_t));
}

/// Squared distance of r = (r_n, r_t) from the projection of (n, t) on the cone.
template <class V>
HWY_INLINE V missed_by_projection(V mu, V n, V t, V r_n, V r_t) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1);
  // Itself inside, else on the ray or the tip.
  const V size = hn::Abs(t), above = positive_part(n);
  const V ray = hn::Div(positive_part(hn::Add(n, hn::Mul(mu, size))), hn::Add(one, hn::Mul(mu, mu)));
  const auto inside = hn::Le(size, hn::Mul(mu, above));
  const V missed_n = hn::Sub(hn::IfThenElse(inside, above, ray), r_n);
  const V missed_t = hn::Sub(hn::IfThenElse(inside, t, hn::CopySign(hn::Mul(mu, ray), t)), r_t);
  return hn::Add(hn::Mul(missed_n, missed_n), hn::Mul(missed_t, missed_t));
}

/// The same with rolling resistance (project_on_cone in particles/contact/cone.hpp).
template <class V>
HWY_INLINE V missed_by_projection(V mu, V mu_r, V n, V t, V r, V r_n, V r_t, V r_r) {
  const hn::DFromV<V> d;
  const V one = hn::Set(d, 1), mu_2 = hn::Mul(mu, mu), mu_r_2 = hn::Mul(mu_r, mu_r);
  const V with_t = hn::Mul(mu, hn::Abs(t)), with_r = hn::Mul(mu_r, hn::Abs(r));
  V along = hn::Max(hn::Zero(d), n);
  along = hn::Max(along, hn::Div(hn::Add(n, with_t), hn::Add(one, mu_2)));
  along = hn::Max(along, hn::Div(hn::Add(n, with_r), hn::Add(one, mu_r_2)));
  along = hn::Max(along, hn::Div(hn::Add(hn::Add(n, with_t), with_r), hn::Add(hn::Add(one, mu_2), mu_r_2)));
  const V missed_n = hn::Sub(along, r_n), missed_t = hn::Sub(clamped(t, hn::Mul(mu, along)), r_t);
  const V missed_r = hn::Sub(clamped(r, hn::Mul(mu_r, along)), r_r);
  return hn::Add(hn::Add(hn::Mul(missed_n, missed_n), hn::Mul(missed_t, missed_t)),
                 hn::Mul(missed_r, missed_r));
}

}  // namespace drumlin::particles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
