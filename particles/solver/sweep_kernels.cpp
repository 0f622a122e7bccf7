// Compiled once for each instruction set: foreach_target.h includes this file again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "particles/solver/sweep_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

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

#if HWY_TARGET == HWY_SCALAR

// A processor without vectors, or one that Highway does not know.
template <class T>
HWY_INLINE BodyVectors<T> load_bodies(const BodyRecord<T>* bodies, const std::int32_t* index) {
  const Lanes<T> d;
  const BodyRecord<T>& b = bodies[index[0]];
  return {hn::Load(d, &b.x), hn::Load(d, &b.z), hn::Load(d, &b.s), hn::Load(d, &b.inverse_mass)};
}
template <class T>
HWY_INLINE void store_bodies(const BodyVectors<T>& v, BodyRecord<T>* bodies, const std::int32_t* index) {
  const Lanes<T> d;
  BodyRecord<T>& b = bodies[index[0]];
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

HWY_INLINE BodyVectors<double> load_bodies(const BodyRecord<double>* bodies, const std::int32_t* index) {
  const Lanes<double> d;
  BodyVectors<double> v;
#if HWY_TARGET <= HWY_AVX2
  transpose_doubles(d, hn::Load(d, &bodies[index[0]].x), hn::Load(d, &bodies[index[1]].x),
                    hn::Load(d, &bodies[index[2]].x), hn::Load(d, &bodies[index[3]].x), v.x, v.z, v.s,
                    v.inverse_mass);
#else
  const auto a = hn::Load(d, &bodies[index[0]].x), b = hn::Load(d, &bodies[index[1]].x);
  const auto c = hn::Load(d, &bodies[index[0]].s), e = hn::Load(d, &bodies[index[1]].s);
  v.x = hn::InterleaveLower(d, a, b), v.z = hn::InterleaveUpper(d, a, b);
  v.s = hn::InterleaveLower(d, c, e), v.inverse_mass = hn::InterleaveUpper(d, c, e);
#endif
  return v;
}

HWY_INLINE void store_bodies(const BodyVectors<double>& v, BodyRecord<double>* bodies,
                             const std::int32_t* index) {
  const Lanes<double> d;
#if HWY_TARGET <= HWY_AVX2
  hn::Vec<Lanes<double>> a, b, c, e;
  transpose_doubles(d, v.x, v.z, v.s, v.inverse_mass, a, b, c, e);
  hn::Store(a, d, &bodies[index[0]].x);
  hn::Store(b, d, &bodies[index[1]].x);
  hn::Store(c, d, &bodies[index[2]].x);
  hn::Store(e, d, &bodies[index[3]].x);
#else
  hn::Store(hn::InterleaveLower(d, v.x, v.z), d, &bodies[index[0]].x);
  hn::Store(hn::InterleaveLower(d, v.s, v.inverse_mass), d, &bodies[index[0]].s);
  hn::Store(hn::InterleaveUpper(d, v.x, v.z), d, &bodies[index[1]].x);
  hn::Store(hn::InterleaveUpper(d, v.s, v.inverse_mass), d, &bodies[index[1]].s);
#endif
}

HWY_INLINE BodyVectors<float> load_bodies(const BodyRecord<float>* bodies, const std::int32_t* index) {
  const Lanes<float> d;
  BodyVectors<float> v;
#if HWY_TARGET <= HWY_AVX2
  const hn::Half<Lanes<float>> half;
  const auto pair = [&](int k) HWY_ATTR {
    return hn::Combine(d, hn::Load(half, &bodies[index[k + 4]].x), hn::Load(half, &bodies[index[k]].x));
  };
  transpose_floats(d, pair(0), pair(1), pair(2), pair(3), v.x, v.z, v.s, v.inverse_mass);
#else
  transpose_floats(d, hn::Load(d, &bodies[index[0]].x), hn::Load(d, &bodies[index[1]].x),
                   hn::Load(d, &bodies[index[2]].x), hn::Load(d, &bodies[index[3]].x), v.x, v.z, v.s,
                   v.inverse_mass);
#endif
  return v;
}

HWY_INLINE void store_bodies(const BodyVectors<float>& v, BodyRecord<float>* bodies,
                             const std::int32_t* index) {
  const Lanes<float> d;
  hn::Vec<Lanes<float>> a, b, c, e;
  transpose_floats(d, v.x, v.z, v.s, v.inverse_mass, a, b, c, e);
#if HWY_TARGET <= HWY_AVX2
  const hn::Half<Lanes<float>> half;
  const auto store = [&](hn::Vec<Lanes<float>> pair, int k) HWY_ATTR {
    hn::Store(hn::LowerHalf(half, pair), half, &bodies[index[k]].x);
    hn::Store(hn::UpperHalf(half, pair), half, &bodies[index[k + 4]].x);
  };
  store(a, 0), store(b, 1), store(c, 2), store(e, 3);
#else
  hn::Store(a, d, &bodies[index[0]].x);
  hn::Store(b, d, &bodies[index[1]].x);
  hn::Store(c, d, &bodies[index[2]].x);
  hn::Store(e, d, &bodies[index[3]].x);
#endif
}

#endif  // HWY_TARGET == HWY_SCALAR

/// Adds impulses (n, t) of contacts to their bodies.
template <int dim, bool spin, class T, class V>
HWY_INLINE void push(V n_x, V n_z, V n, V t, BodyVectors<T>& I, BodyVectors<T>& J) {
  V p_x = hn::Mul(n_x, n), p_z = hn::Mul(n_z, n);
  if constexpr (dim == 2) {
    p_x = hn::Add(p_x, hn::Mul(n_z, t));
    p_z = hn::Sub(p_z, hn::Mul(n_x, t));
  }
  I.x = hn::Add(I.x, hn::Mul(I.inverse_mass, p_x));
  I.z = hn::Add(I.z, hn::Mul(I.inverse_mass, p_z));
  J.x = hn::Sub(J.x, hn::Mul(J.inverse_mass, p_x));
  J.z = hn::Sub(J.z, hn::Mul(J.inverse_mass, p_z));
  if constexpr (spin) {  // r J^-1 (-r r_t) = -2 r_t / m, for both bodies
    const V twice = hn::Add(t, t);
    I.s = hn::Sub(I.s, hn::Mul(I.inverse_mass, twice));
    J.s = hn::Sub(J.s, hn::Mul(J.inverse_mass, twice));
  }
}

template <class T, int dim, bool spin>
void load(const ContactBlock<T, dim>* blocks, std::size_t count, BodyRecord<T>* bodies) {
  const Lanes<T> d;
  constexpr int width = ContactBlock<T, dim>::width;
  for (std::size_t b = 0; b < count; ++b) {
    const auto& block = blocks[b];
    for (std::size_t k = 0; k < width; k += hn::Lanes(d)) {
      auto I = load_bodies(bodies, &block.i[k]), J = load_bodies(bodies, &block.j[k]);
      const auto n = hn::Load(d, &block.r[0][k]), t = dim == 2 ? hn::Load(d, &block.r[dim - 1][k]) : n;
      push<dim, spin, T>(hn::Load(d, &block.n_x[k]), hn::Load(d, &block.n_z[k]), n, t, I, J);
      store_bodies(I, bodies, &block.i[k]);
      store_bodies(J, bodies, &block.j[k]);
    }
  }
}

template <class T>
HWY_INLINE double total(const std::array<T, 8>& sums) {
  double sum = 0;
  for (const T s : sums) sum += static_cast<double>(s);
  return sum;
}

template <class T, int dim, bool spin, bool accelerated>
double sweep(ContactBlock<T, dim>* blocks, std::size_t count, BodyRecord<T>* bodies, T beta_) {
  const Lanes<T> d;
  using V = hn::Vec<Lanes<T>>;
  constexpr int width = ContactBlock<T, dim>::width;
  const V zero = hn::Zero(d), beta = hn::Set(d, beta_);
  const V ratio = hn::Set(d, spin ? T(1) / T(3) : T(1));  // W_nn / W_tt
  // Eight sums whatever the length of a vector.
  HWY_ALIGN std::array<T, width> squares{};
  for (std::size_t b = 0; b < count; ++b) {
    auto& block = blocks[b];
    for (std::size_t k = 0; k < width; k += hn::Lanes(d)) {
      auto I = load_bodies(bodies, &block.i[k]), J = load_bodies(bodies, &block.j[k]);
      const V n_x = hn::Load(d, &block.n_x[k]), n_z = hn::Load(d, &block.n_z[k]);
      const V w = hn::Load(d, &block.inverse_W_nn[k]);
      const V dv_x = hn::Sub(I.x, J.x), dv_z = hn::Sub(I.z, J.z);
      V r_n = hn::Load(d, &block.r[0][k]);
      if constexpr (accelerated) {
        const V now = r_n;
        r_n = hn::Add(now, hn::Mul(beta, hn::Sub(now, hn::Load(d, &block.before[0][k]))));
        hn::Store(now, d, &block.before[0][k]);
      }
      const V u_n = hn::Add(hn::Load(d, &block.q[0][k]), hn::Add(hn::Mul(n_x, dv_x), hn::Mul(n_z, dv_z)));
      // Max(a, NaN) is NaN, Max(NaN, a) is not.
      const V new_n = hn::Max(zero, hn::Sub(r_n, hn::Mul(u_n, w)));
      const V dr_n = hn::Sub(new_n, r_n);
      hn::Store(new_n, d, &block.r[0][k]);
      V sum = hn::Mul(dr_n, dr_n);
      V dr_t = zero;
      if constexpr (dim == 2) {
        V r_t = hn::Load(d, &block.r[dim - 1][k]);
        if constexpr (accelerated) {
          const V now = r_t;
          r_t = hn::Add(now, hn::Mul(beta, hn::Sub(now, hn::Load(d, &block.before[dim - 1][k]))));
          hn::Store(now, d, &block.before[dim - 1][k]);
        }
        V slip = hn::Sub(hn::Mul(n_z, dv_x), hn::Mul(n_x, dv_z));
        if constexpr (spin) slip = hn::Sub(slip, hn::Add(I.s, J.s));
        const V u_t = hn::Add(hn::Load(d, &block.q[dim - 1][k]), slip);
        const V bound = hn::Mul(hn::Load(d, &block.mu[k]), new_n);
        const V wanted = hn::Sub(r_t, hn::Mul(u_t, hn::Mul(w, ratio)));
        const V new_t = hn::Min(bound, hn::Max(hn::Neg(bound), wanted));
        dr_t = hn::Sub(new_t, r_t);
        hn::Store(new_t, d, &block.r[dim - 1][k]);
        sum = hn::Add(sum, hn::Mul(dr_t, dr_t));
      }
      hn::Store(hn::Add(hn::Load(d, &squares[k]), sum), d, &squares[k]);
      push<dim, spin, T>(n_x, n_z, dr_n, dr_t, I, J);
      store_bodies(I, bodies, &block.i[k]);
      store_bodies(J, bodies, &block.j[k]);
    }
  }
  return total(squares);
}

template <class T, int dim, bool spin>
double residual(const ContactBlock<T, dim>* blocks, std::size_t count, const BodyRecord<T>* bodies) {
  const Lanes<T> d;
  using V = hn::Vec<Lanes<T>>;
  constexpr int width = ContactBlock<T, dim>::width;
  const V zero = hn::Zero(d), one = hn::Set(d, T(1));
  const V ratio = hn::Set(d, dim == 2 && spin ? T(1) / T(3) : T(1));  // W_nn / lambda_max
  HWY_ALIGN std::array<T, width> squares{};
  for (std::size_t b = 0; b < count; ++b) {
    const auto& block = blocks[b];
    for (std::size_t k = 0; k < width; k += hn::Lanes(d)) {
      const auto I = load_bodies(bodies, &block.i[k]), J = load_bodies(bodies, &block.j[k]);
      const V n_x = hn::Load(d, &block.n_x[k]), n_z = hn::Load(d, &block.n_z[k]);
      const V rho = hn::Mul(hn::Load(d, &block.inverse_W_nn[k]), ratio);
      const V dv_x = hn::Sub(I.x, J.x), dv_z = hn::Sub(I.z, J.z);
      const V r_n = hn::Load(d, &block.r[0][k]);
      V u_n = hn::Add(hn::Load(d, &block.q[0][k]), hn::Add(hn::Mul(n_x, dv_x), hn::Mul(n_z, dv_z)));
      V sum;
      if constexpr (dim == 1) {
        const V missed = hn::Sub(hn::Max(zero, hn::Sub(r_n, hn::Mul(rho, u_n))), r_n);
        sum = hn::Mul(missed, missed);
      } else {
        V slip = hn::Sub(hn::Mul(n_z, dv_x), hn::Mul(n_x, dv_z));
        if constexpr (spin) slip = hn::Sub(slip, hn::Add(I.s, J.s));
        const V u_t = hn::Add(hn::Load(d, &block.q[dim - 1][k]), slip);
        const V mu = hn::Load(d, &block.mu[k]), r_t = hn::Load(d, &block.r[dim - 1][k]);
        u_n = hn::Add(u_n, hn::Mul(mu, hn::Abs(u_t)));  // De Saxce
        const V n = hn::Sub(r_n, hn::Mul(rho, u_n)), t = hn::Sub(r_t, hn::Mul(rho, u_t));
        // Projection on the cone: itself inside, else on the ray or the tip.
        const V size = hn::Abs(t);
        const V ray = hn::Div(hn::Max(zero, hn::Add(n, hn::Mul(mu, size))), hn::Add(one, hn::Mul(mu, mu)));
        const auto inside = hn::Le(size, hn::Mul(mu, n));
        const V missed_n = hn::Sub(hn::IfThenElse(inside, n, ray), r_n);
        const V missed_t = hn::Sub(hn::IfThenElse(inside, t, hn::CopySign(hn::Mul(mu, ray), t)), r_t);
        sum = hn::Add(hn::Mul(missed_n, missed_n), hn::Mul(missed_t, missed_t));
      }
      sum = hn::Div(sum, hn::Mul(rho, rho));
      hn::Store(hn::Add(hn::Load(d, &squares[k]), sum), d, &squares[k]);
    }
  }
  return total(squares);
}

template <class T>
void go_on(BodyRecord<T>* bodies, BodyRecord<T>* before, std::size_t count, T beta_) {
  const Lanes<T> d;
  const auto beta = hn::Set(d, beta_);
  T *now = &bodies->x, *then = &before->x;
  // Inverse masses stand still: their difference is zero.
  for (std::size_t k = 0; k < 4 * count; k += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, now + k);
    hn::StoreU(hn::Add(x, hn::Mul(beta, hn::Sub(x, hn::LoadU(d, then + k)))), d, now + k);
    hn::StoreU(x, d, then + k);
  }
}

#define DRUMLIN_KERNELS(T, name, dim, spin)                                                             \
  void load_##name(const ContactBlock<T, dim>* b, std::size_t n, BodyRecord<T>* v) {                    \
    load<T, dim, spin>(b, n, v);                                                                        \
  }                                                                                                     \
  double sweep_##name(ContactBlock<T, dim>* b, std::size_t n, BodyRecord<T>* v, T beta, bool fast) {    \
    return fast ? sweep<T, dim, spin, true>(b, n, v, beta) : sweep<T, dim, spin, false>(b, n, v, beta); \
  }                                                                                                     \
  double residual_##name(const ContactBlock<T, dim>* b, std::size_t n, const BodyRecord<T>* v) {        \
    return residual<T, dim, spin>(b, n, v);                                                             \
  }
DRUMLIN_KERNELS(double, double_smooth, 1, false)
DRUMLIN_KERNELS(double, double_friction, 2, false)
DRUMLIN_KERNELS(double, double_spin, 2, true)
DRUMLIN_KERNELS(float, float_smooth, 1, false)
DRUMLIN_KERNELS(float, float_friction, 2, false)
DRUMLIN_KERNELS(float, float_spin, 2, true)
#undef DRUMLIN_KERNELS

void go_on_double(BodyRecord<double>* bodies, BodyRecord<double>* before, std::size_t n, double beta) {
  go_on<double>(bodies, before, n, beta);
}
void go_on_float(BodyRecord<float>* bodies, BodyRecord<float>* before, std::size_t n, float beta) {
  go_on<float>(bodies, before, n, beta);
}

}  // namespace drumlin::particles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace drumlin::particles {

HWY_EXPORT(go_on_double);
HWY_EXPORT(go_on_float);

#define DRUMLIN_DISPATCH(T, precision, name, dim, spin)                                                     \
  HWY_EXPORT(load_##name);                                                                                  \
  HWY_EXPORT(residual_##name);                                                                              \
  HWY_EXPORT(sweep_##name);                                                                                 \
  template <>                                                                                               \
  void SweepKernels<T, dim, spin>::load(const Block* blocks, std::size_t count, BodyRecord<T>* bodies) {    \
    HWY_DYNAMIC_DISPATCH(load_##name)(blocks, count, bodies);                                               \
  }                                                                                                         \
  template <>                                                                                               \
  double SweepKernels<T, dim, spin>::sweep(Block* blocks, std::size_t count, BodyRecord<T>* bodies, T beta, \
                                           bool accelerated) {                                              \
    return HWY_DYNAMIC_DISPATCH(sweep_##name)(blocks, count, bodies, beta, accelerated);                    \
  }                                                                                                         \
  template <>                                                                                               \
  double SweepKernels<T, dim, spin>::residual(const Block* blocks, std::size_t count,                       \
                                              const BodyRecord<T>* bodies) {                                \
    return HWY_DYNAMIC_DISPATCH(residual_##name)(blocks, count, bodies);                                    \
  }                                                                                                         \
  template <>                                                                                               \
  void SweepKernels<T, dim, spin>::go_on(BodyRecord<T>* bodies, BodyRecord<T>* before, std::size_t count,   \
                                         T beta) {                                                          \
    HWY_DYNAMIC_DISPATCH(go_on_##precision)(bodies, before, count, beta);                                   \
  }
DRUMLIN_DISPATCH(double, double, double_smooth, 1, false)
DRUMLIN_DISPATCH(double, double, double_friction, 2, false)
DRUMLIN_DISPATCH(double, double, double_spin, 2, true)
DRUMLIN_DISPATCH(float, float, float_smooth, 1, false)
DRUMLIN_DISPATCH(float, float, float_friction, 2, false)
DRUMLIN_DISPATCH(float, float, float_spin, 2, true)
#undef DRUMLIN_DISPATCH

}  // namespace drumlin::particles
#endif  // HWY_ONCE
