// Compiled once for each instruction set: foreach_target.h includes this file again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "particles/solver/coarse_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "particles/contact_law/laws-inl.h"
#include "particles/solver/body_vectors-inl.h"
#include "particles/solver/coarse_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace drumlin::particles::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class T, class Law, bool spin>
void add_contacts(const ContactBlock<T, Law>* blocks, std::size_t count, const BodyRecord<T>* bodies,
                  const CoarseBodies<T>& coarse) {
  const Lanes<T> d;
  using V = hn::Vec<Lanes<T>>;
  constexpr std::size_t width = ContactBlock<T, Law>::width;

  const V zero = hn::Zero(d);
  for (std::size_t b = 0; b < count; ++b) {
    const auto& block = blocks[b];
    for (std::size_t k = 0; k < width; k += hn::Lanes(d)) {
      const auto I = load_bodies(bodies, &block.i[k]), J = load_bodies(bodies, &block.j[k]);
      auto at_i = load_bodies(coarse.at, &block.i[k]);
      const auto at_j = load_bodies(coarse.at, &block.j[k]);
      const V n_x = hn::Load(d, &block.n_x[k]), n_z = hn::Load(d, &block.n_z[k]);
      const V r_n = hn::Load(d, &block.r[0][k]);
      const V dv_x = hn::Sub(I.x, J.x), dv_z = hn::Sub(I.z, J.z);
      const V u_n = hn::Add(hn::Load(d, &block.q[0][k]), hn::Add(hn::Mul(n_x, dv_x), hn::Mul(n_z, dv_z)));
      V power = hn::Mul(r_n, u_n), p_x = hn::Mul(n_x, r_n), p_z = hn::Mul(n_z, r_n), couple = zero;
      if constexpr (Law::unknowns == 2) {
        const V r_t = hn::Load(d, &block.r[1][k]);
        V slip = hn::Sub(hn::Mul(n_z, dv_x), hn::Mul(n_x, dv_z));
        if constexpr (spin) slip = hn::Sub(slip, hn::Add(I.s, J.s)), couple = hn::Add(r_t, r_t);
        const V u_t = hn::Add(hn::Load(d, &block.q[1][k]), slip);
        const V taken = contact_law::sliding_power<V>({hn::Load(d, &block.mu[0][k])}, {r_n, r_t}, {u_n, u_t});
        power = hn::Add(power, hn::Add(hn::Mul(r_t, u_t), taken));
        p_x = hn::Add(p_x, hn::Mul(n_z, r_t)), p_z = hn::Sub(p_z, hn::Mul(n_x, r_t));
      }
      at_i.s = hn::Add(at_i.s, power);
      store_bodies(at_i, coarse.at, &block.i[k]);
      // Seen from the second body.
      const V m = hn::Neg(J.inverse_mass);
      const auto move = [&](BodyRecord<T>* along, V distance) HWY_ATTR {
        auto S = load_bodies(along, &block.j[k]);
        const V per_mass = hn::Mul(m, distance);
        S.x = hn::Add(S.x, hn::Mul(per_mass, p_x));
        S.z = hn::Add(S.z, hn::Mul(per_mass, p_z));
        if constexpr (spin) S.s = hn::Add(S.s, hn::Mul(per_mass, couple));
        store_bodies(S, along, &block.j[k]);
      };
      move(coarse.along_x, hn::Sub(at_i.x, at_j.x));
      move(coarse.along_z, hn::Sub(at_i.z, at_j.z));
    }
  }
}

template <class T, class Law>
void scale(ContactBlock<T, Law>* blocks, std::size_t count, const BodyRecord<T>* factors) {
  const Lanes<T> d;
  constexpr std::size_t width = ContactBlock<T, Law>::width;
  for (std::size_t b = 0; b < count; ++b) {
    auto& block = blocks[b];
    for (std::size_t k = 0; k < width; k += hn::Lanes(d)) {
      const auto factor = load_bodies(factors, &block.i[k]).s;
      for (std::size_t e = 0; e < Law::unknowns; ++e) {
        const auto r = hn::Mul(hn::Load(d, &block.r[e][k]), factor);
        hn::Store(r, d, &block.r[e][k]), hn::Store(r, d, &block.before[e][k]);
      }
    }
  }
}

/// Three numbers for each corner of a cell, or one velocity.
template <class V>
struct Three {
  V a, b, c;
};

/// Of m v . w + J omega omega' with s = r omega.
template <class T, class V>
HWY_INLINE V energy(V mass, const BodyVectors<T>& v, const BodyVectors<T>& w) {
  const V inertia = hn::Set(Lanes<T>(), T(disc_inertia));
  const V sum = hn::Add(hn::Mul(v.x, w.x), hn::Mul(v.z, w.z));
  return hn::Mul(mass, hn::Add(sum, hn::Mul(inertia, hn::Mul(v.s, w.s))));
}

template <class T>
void terms(const BodyRecord<T>* bodies, const CoarseBodies<T>& coarse, const std::uint32_t* places,
           T last_column, T last_row, CoarseTerms<T>& terms) {
  const Lanes<T> d;
  using V = hn::Vec<Lanes<T>>;
  const V one = hn::Set(d, T(1));
  for (std::size_t k = 0; k < terms.width; k += hn::Lanes(d)) {
    const auto v = load_bodies(bodies, places + k), at = load_bodies(coarse.at, places + k);
    const auto S_x = load_bodies(coarse.along_x, places + k), S_z = load_bodies(coarse.along_z, places + k);
    // Bodies that do not move take no part.
    const auto moves = hn::Gt(v.inverse_mass, hn::Zero(d));
    const V mass = hn::IfThenElseZero(moves, hn::Div(one, hn::IfThenElse(moves, v.inverse_mass, one)));
    const Three<V> of_v{energy<T>(mass, v, v), energy<T>(mass, v, S_x), energy<T>(mass, v, S_z)};
    const Three<V> of_x{of_v.b, energy<T>(mass, S_x, S_x), energy<T>(mass, S_x, S_z)};
    const Three<V> of_z{of_v.c, of_x.c, energy<T>(mass, S_z, S_z)};
    const V right = hn::Sub(at.x, hn::Min(hn::Floor(at.x), hn::Set(d, last_column)));
    const V up = hn::Sub(at.z, hn::Min(hn::Floor(at.z), hn::Set(d, last_row)));
    const V left = hn::Sub(one, right), down = hn::Sub(one, up);
    // phi and its derivatives along x and z.
    const std::array<Three<V>, 4> phi{{{hn::Mul(left, down), hn::Neg(down), hn::Neg(left)},
                                       {hn::Mul(right, down), down, hn::Neg(right)},
                                       {hn::Mul(left, up), hn::Neg(up), left},
                                       {hn::Mul(right, up), up, right}}};
    const auto product = [&](const Three<V>& p, const Three<V>& q) HWY_ATTR {
      return hn::Add(hn::Mul(p.a, q.a), hn::Add(hn::Mul(p.b, q.b), hn::Mul(p.c, q.c)));
    };
    for (std::size_t corner = 0; corner < 4; ++corner)
      hn::Store(hn::Mul(phi[corner].a, at.s), d, &terms.powers[corner][k]);
    for (std::size_t p = 0; p < terms.pairs.size(); ++p) {
      const Three<V>& own = phi[terms.pairs[p].k];
      const Three<V> with{product(own, of_v), product(own, of_x), product(own, of_z)};
      hn::Store(product(with, phi[terms.pairs[p].l]), d, &terms.energies[p][k]);
    }
  }
}

#define DRUMLIN_KERNELS_OF(T, Problem, Law, spin)                                                \
  void add_##T##_##Problem(const ContactBlock<T, Law>* b, std::size_t n, const BodyRecord<T>* v, \
                           const CoarseBodies<T>& c) {                                           \
    add_contacts<T, Law, spin>(b, n, v, c);                                                      \
  }                                                                                              \
  void scale_##T##_##Problem(ContactBlock<T, Law>* b, std::size_t n, const BodyRecord<T>* f) {   \
    scale<T, Law>(b, n, f);                                                                      \
  }
#define DRUMLIN_KERNELS(Problem, Law, spin) \
  DRUMLIN_KERNELS_OF(double, Problem, Law, spin) DRUMLIN_KERNELS_OF(float, Problem, Law, spin)
DRUMLIN_EACH_PLAIN_PROBLEM(DRUMLIN_KERNELS)
#undef DRUMLIN_KERNELS
#undef DRUMLIN_KERNELS_OF

void terms_double(const BodyRecord<double>* v, const CoarseBodies<double>& c, const std::uint32_t* places,
                  double last_column, double last_row, CoarseTerms<double>& found) {
  terms<double>(v, c, places, last_column, last_row, found);
}
void terms_float(const BodyRecord<float>* v, const CoarseBodies<float>& c, const std::uint32_t* places,
                 float last_column, float last_row, CoarseTerms<float>& found) {
  terms<float>(v, c, places, last_column, last_row, found);
}

}  // namespace drumlin::particles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace drumlin::particles {

HWY_EXPORT(terms_double);
HWY_EXPORT(terms_float);

#define DRUMLIN_DISPATCH(T)                                                                                  \
  template <>                                                                                                \
  CoarseTerms<T> coarse_terms(const FieldGrid& grid, const BodyRecord<T>* bodies,                            \
                              const CoarseBodies<T>& coarse, std::size_t first, std::size_t count) {         \
    CoarseTerms<T> terms;                                                                                    \
    std::array<std::uint32_t, CoarseTerms<T>::width> places;                                                 \
    for (std::size_t k = 0; k < places.size(); ++k)                                                          \
      places[k] = static_cast<std::uint32_t>((first + std::min(k, count - 1)) * sizeof(BodyRecord<T>));      \
    HWY_DYNAMIC_DISPATCH(terms_##T)                                                                          \
    (bodies, coarse, places.data(), static_cast<T>(grid.columns - 2), static_cast<T>(grid.rows - 2), terms); \
    return terms;                                                                                            \
  }
DRUMLIN_DISPATCH(double)
DRUMLIN_DISPATCH(float)
#undef DRUMLIN_DISPATCH

#define DRUMLIN_DISPATCH_OF(T, Problem, Law, spin)                                                          \
  HWY_EXPORT(add_##T##_##Problem);                                                                          \
  HWY_EXPORT(scale_##T##_##Problem);                                                                        \
  template <>                                                                                               \
  void CoarseKernels<T, Law, spin>::add_contacts(                                                           \
      const Block* blocks, std::size_t count, const BodyRecord<T>* bodies, const CoarseBodies<T>& coarse) { \
    HWY_DYNAMIC_DISPATCH(add_##T##_##Problem)(blocks, count, bodies, coarse);                               \
  }                                                                                                         \
  template <>                                                                                               \
  void CoarseKernels<T, Law, spin>::scale(Block* blocks, std::size_t count, const BodyRecord<T>* factors) { \
    HWY_DYNAMIC_DISPATCH(scale_##T##_##Problem)(blocks, count, factors);                                    \
  }
#define DRUMLIN_DISPATCH(Problem, Law, spin) \
  DRUMLIN_DISPATCH_OF(double, Problem, Law, spin) DRUMLIN_DISPATCH_OF(float, Problem, Law, spin)
DRUMLIN_EACH_PLAIN_PROBLEM(DRUMLIN_DISPATCH)
#undef DRUMLIN_DISPATCH
#undef DRUMLIN_DISPATCH_OF

}  // namespace drumlin::particles
#endif  // HWY_ONCE
