// Compiled once for each instruction set: foreach_target.h includes this file again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "particles/solver/sweep_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include <utility>

#include "particles/contact_law/laws-inl.h"
#include "particles/solver/body_vectors-inl.h"
#include "particles/solver/sweep_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace drumlin::particles::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class T>
HWY_INLINE double total(const std::array<T, 8>& sums) {
  double sum = 0;
  for (const T s : sums) sum += static_cast<double>(s);
  return sum;
}

/// Impulses that a sweep starts from, and what is rounded off of them.
template <class V>
struct Started {
  V r, rounded_off;
};

/// Extrapolated, `before` becomes what the impulses are.
template <SweepExtrapolation how, class T, class V>
HWY_INLINE Started<V> started_from(const std::array<T, 8>& r, std::array<T, 8>& before, std::size_t k,
                                   V beta) {
  const Lanes<T> d;
  const V now = hn::Load(d, &r[k]), zero = hn::Zero(d);
  if constexpr (how == SweepExtrapolation::none) return {now, zero};
  const V then = hn::Load(d, &before[k]);
  hn::Store(now, d, &before[k]);
  const V way = hn::Mul(beta, hn::Sub(now, then)), start = hn::Add(now, way);
  if constexpr (how == SweepExtrapolation::rounded) return {start, zero};
  return {start, hn::Sub(hn::Sub(start, now), way)};  // to the last bit where |way| <= |now| (Dekker 1971)
}

/// A vector of contacts: those of a block from k on.
template <class T, class Law>
struct Place {
  ContactBlock<T, Law>* block;
  std::size_t k;
};

template <class T, int dim>
using Impulses = std::array<hn::Vec<Lanes<T>>, static_cast<std::size_t>(dim)>;

/// The Law::unknowns numbers of contacts that stand in arrays of them.
template <std::size_t dim, class T, std::size_t all>
HWY_INLINE Impulses<T, dim> load_numbers(const std::array<std::array<T, 8>, all>& arrays, std::size_t k) {
  Impulses<T, dim> numbers;
  for (std::size_t e = 0; e < dim; ++e) numbers[e] = hn::Load(Lanes<T>(), &arrays[e][k]);
  return numbers;
}

/// Coefficients of the law of contacts.
template <class T, class Law>
HWY_INLINE contact_law::Coefficients<hn::Vec<Lanes<T>>, Law> coefficients(const ContactBlock<T, Law>& block,
                                                                          std::size_t k) {
  if constexpr (Law::coefficients == 0)
    return {};
  else
    return load_numbers<Law::coefficients>(block.mu, k);
}

/// Normals and ratios of radii of contacts.
template <class T, class Law>
HWY_INLINE contact_law::ContactFrame<hn::Vec<Lanes<T>>> frame_of(const ContactBlock<T, Law>& block,
                                                                 std::size_t k) {
  const Lanes<T> d;
  const auto n_x = hn::Load(d, &block.n_x[k]), n_z = hn::Load(d, &block.n_z[k]);
  if constexpr (Law::unknowns == 3) return {n_x, n_z, hn::Load(d, &block.radius_ratio[k])};
  return {n_x, n_z, hn::Zero(d)};
}

/// u = W r + q of contacts, from the velocities of their bodies.
template <bool spin, class T, class Law>
HWY_INLINE Impulses<T, Law::unknowns> velocities(const ContactBlock<T, Law>& block, std::size_t k,
                                                 const BodyVectors<T>& I, const BodyVectors<T>& J) {
  const auto own =
      contact_law::relative_velocity<spin, Law::unknowns>(frame_of(block, k), I.x - J.x, I.z - J.z, I, J);
  auto u = load_numbers<Law::unknowns>(block.q, k);
  for (std::size_t e = 0; e < Law::unknowns; ++e) u[e] = u[e] + own[e];
  return u;
}

template <bool spin, class T, class Law>
HWY_INLINE auto inverse_block(const ContactBlock<T, Law>& block, std::size_t k, const BodyVectors<T>& I,
                              const BodyVectors<T>& J) {
  const Lanes<T> d;
  contact_law::InverseBlock<hn::Vec<Lanes<T>>, Law::unknowns> W;
  W.nn = hn::Load(d, &block.inverse_W_nn[k]);
  if constexpr (Law::unknowns >= 2) W.tt = W.nn * hn::Set(d, T(1) / T(tangential_gain<spin>));
  if constexpr (Law::unknowns == 3) {
    const auto turns = contact_law::turns_of(hn::Load(d, &block.radius_ratio[k]), I, J);
    W.rr = hn::Load(d, &block.inverse_W_rr[k]), W.tr = turns[1] - turns[0];
    W.tt_reduced = hn::Load(d, &block.inverse_W_tt[k]);
  }
  return W;
}

/// What a sweep knows of a vector of contacts: their bodies, their steps, and the sum of squares of these.
template <class T, class Law>
struct SweptContacts {
  BodyVectors<T> I, J;
  Impulses<T, Law::unknowns> step;
  hn::Vec<Lanes<T>> squares;
};

template <class T, class Law, bool spin, SweepExtrapolation how, class V>
HWY_INLINE void solve(const Place<T, Law>& at, V beta, SweptContacts<T, Law>& c) {
  const Lanes<T> d;
  auto& [block, k] = at;
  Impulses<T, Law::unknowns> start, rounded_off;
  for (std::size_t e = 0; e < Law::unknowns; ++e) {
    const auto from = started_from<how>(block->r[e], block->before[e], k, beta);
    start[e] = from.r, rounded_off[e] = from.rounded_off;
  }
  const auto fresh =
      contact_law::solved(Law{}, inverse_block<spin>(*block, k, c.I, c.J), coefficients(*block, k),
                          velocities<spin>(*block, k, c.I, c.J), start);
  for (std::size_t e = 0; e < Law::unknowns; ++e) {
    const V step = fresh[e] - start[e];
    c.squares = e == 0 ? step * step : c.squares + step * step;
    c.step[e] = how == SweepExtrapolation::exact ? step + rounded_off[e] : step;
    hn::Store(fresh[e], d, &block->r[e][k]);
  }
}

template <class T, class Law>
HWY_INLINE void bring_bodies(const Place<T, Law>& at, const BodyRecord<T>* bodies, SweptContacts<T, Law>& c) {
  c.I = load_bodies(bodies, &at.block->i[at.k]);
  c.J = load_bodies(bodies, &at.block->j[at.k]);
}

/// Gives impulses of contacts to their bodies.
template <bool spin, class T, class Law>
HWY_INLINE void push_bodies(const ContactBlock<T, Law>& block, std::size_t k,
                            const Impulses<T, Law::unknowns>& p, BodyVectors<T>& I, BodyVectors<T>& J,
                            BodyRecord<T>* bodies) {
  contact_law::push<spin>(frame_of(block, k), p, I, J);
  store_bodies(I, bodies, &block.i[k]);
  store_bodies(J, bodies, &block.j[k]);
}

template <class T, class Law, bool spin>
void load(const ContactBlock<T, Law>* blocks, std::size_t count, BodyRecord<T>* bodies) {
  constexpr int width = ContactBlock<T, Law>::width;
  for (std::size_t b = 0; b < count; ++b) {
    const auto& block = blocks[b];
    for (std::size_t k = 0; k < width; k += hn::Lanes(Lanes<T>())) {
      auto I = load_bodies(bodies, &block.i[k]), J = load_bodies(bodies, &block.j[k]);
      push_bodies<spin>(block, k, load_numbers<Law::unknowns>(block.r, k), I, J, bodies);
    }
  }
}

template <class T, class Law, bool spin, SweepExtrapolation how>
double sweep(ContactBlock<T, Law>* blocks, std::span<const std::int32_t> groups, BodyRecord<T>* bodies,
             T beta_) {
  const Lanes<T> d;
  constexpr std::size_t width = ContactBlock<T, Law>::width;
  const std::size_t lanes = hn::Lanes(d);
  const auto beta = hn::Set(d, beta_);
  // Eight sums whatever the length of a vector.
  HWY_ALIGN std::array<T, width> squares{};
  const auto solve_and_add = [&](const Place<T, Law>& at, SweptContacts<T, Law>& c) HWY_ATTR {
    solve<T, Law, spin, how>(at, beta, c);
    hn::Store(hn::Add(hn::Load(d, &squares[at.k]), c.squares), d, &squares[at.k]);
  };
  for (const std::int32_t count : groups) {
    if (count == 0) continue;
    ContactBlock<T, Law>* const first = std::exchange(blocks, blocks + count);
    // The chain of operations of one vector is longer than what a processor looks ahead: the bodies of the
    // next one come while this one's are pushed.
    Place<T, Law> at{first, 0};
    SweptContacts<T, Law> c, next;
    bring_bodies(at, bodies, c);
    for (std::size_t left = count * (width / lanes) - 1; left > 0; --left) {
      solve_and_add(at, c);

      const bool whole = at.k + lanes == width;
      const Place<T, Law> after{whole ? at.block + 1 : at.block, whole ? 0 : at.k + lanes};
      bring_bodies(after, bodies, next);
      push_bodies<spin>(*at.block, at.k, c.step, c.I, c.J, bodies);
      at = after;
      c.I = next.I, c.J = next.J;
    }
    solve_and_add(at, c);

    push_bodies<spin>(*at.block, at.k, c.step, c.I, c.J, bodies);
  }
  return total(squares);
}

template <class T, class Law, bool spin>
double sweep(ContactBlock<T, Law>* blocks, std::span<const std::int32_t> groups, BodyRecord<T>* bodies,
             T beta, SweepExtrapolation how) {
  using enum SweepExtrapolation;
  if (how == none) return sweep<T, Law, spin, none>(blocks, groups, bodies, beta);
  if constexpr (sizeof(T) < sizeof(double))
    if (how == exact) return sweep<T, Law, spin, exact>(blocks, groups, bodies, beta);
  return sweep<T, Law, spin, rounded>(blocks, groups, bodies, beta);
}

/// 1 / lambda_max(W_aa) of contacts: of discs that turn W_nn is below W_tt.
template <class T, class Law, bool spin>
HWY_INLINE auto inverse_eigenvalue(const ContactBlock<T, Law>& block, std::size_t k, const BodyVectors<T>& I,
                                   const BodyVectors<T>& J) {
  const Lanes<T> d;
  if constexpr (Law::unknowns < 3) {
    return hn::Load(d, &block.inverse_W_nn[k]) *
           hn::Set(d, T(1) / T(tangential_gain<(Law::unknowns == 2 && spin)>));
  } else {
    const auto w = I.inverse_mass + J.inverse_mass, radius_ratio = hn::Load(d, &block.radius_ratio[k]);
    const auto turns = contact_law::turns_of(radius_ratio, I, J);
    const auto largest = contact_law::larger_eigenvalue(
        w * hn::Set(d, T(tangential_gain<spin>)), turns[1] - turns[0],
        radius_ratio * turns[0] + (hn::Set(d, T(1)) - radius_ratio) * turns[1]);
    // Positions that are filled up have none.
    return hn::Set(d, T(1)) / hn::Max(largest, hn::Set(d, T(1e-15)));
  }
}

template <class T, class Law, bool spin>
ResidualEstimate residual(const ContactBlock<T, Law>* blocks, std::size_t count,
                          const BodyRecord<T>* bodies) {
  const Lanes<T> d;
  constexpr int width = ContactBlock<T, Law>::width;
  HWY_ALIGN std::array<T, width> squares{};
  HWY_ALIGN std::array<T, width> complementarity_violation{};
  HWY_ALIGN std::array<T, width> lowest_u_n{};
  for (std::size_t b = 0; b < count; ++b) {
    const auto& block = blocks[b];
    for (std::size_t k = 0; k < width; k += hn::Lanes(d)) {
      const auto I = load_bodies(bodies, &block.i[k]), J = load_bodies(bodies, &block.j[k]);
      const auto rho = inverse_eigenvalue<T, Law, spin>(block, k, I, J);
      const auto r = load_numbers<Law::unknowns>(block.r, k), u = velocities<spin>(block, k, I, J);
      const auto closing = hn::Min(hn::Zero(d), u[0]);
      hn::Store(hn::Load(d, &complementarity_violation[k]) - r[0] * closing, d,
                &complementarity_violation[k]);
      hn::Store(hn::Min(hn::Load(d, &lowest_u_n[k]), closing), d, &lowest_u_n[k]);
      const auto square = contact_law::squared_natural_residual(Law{}, rho, coefficients(block, k), r, u);
      hn::Store(hn::Load(d, &squares[k]) + square / (rho * rho), d, &squares[k]);
    }
  }
  return {total(squares), total(complementarity_violation),
          *std::min_element(lowest_u_n.begin(), lowest_u_n.end())};
}

/// x becomes x + beta (x - before), and `before` what x was; returns the first number that is left over.
template <class D, class T>
HWY_INLINE std::size_t go_on(D d, T* now, T* before, std::size_t first, std::size_t end, T beta_) {
  const auto beta = hn::Set(d, beta_);
  for (; first + hn::Lanes(d) <= end; first += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, now + first);
    hn::StoreU(hn::Add(x, hn::Mul(beta, hn::Sub(x, hn::LoadU(d, before + first)))), d, now + first);
    hn::StoreU(x, d, before + first);
  }
  return first;
}

template <class T>
void go_on(BodyRecord<T>* bodies, BodyRecord<T>* before, std::size_t count, T beta) {
  // Inverse masses stand still: their difference is zero.
  const std::size_t most = go_on(Lanes<T>(), &bodies->x, &before->x, 0, 4 * count, beta);
  const hn::CappedTag<T, 4> of_a_record;
  go_on(of_a_record, &bodies->x, &before->x, most, 4 * count, beta);
}

#define DRUMLIN_KERNELS_OF(T, Problem, Law, spin)                                             \
  void load_##T##_##Problem(const ContactBlock<T, Law>* b, std::size_t n, BodyRecord<T>* v) { \
    load<T, Law, spin>(b, n, v);                                                              \
  }                                                                                           \
  double sweep_##T##_##Problem(ContactBlock<T, Law>* b, std::span<const std::int32_t> groups, \
                               BodyRecord<T>* v, T beta, SweepExtrapolation how) {            \
    return sweep<T, Law, spin>(b, groups, v, beta, how);                                      \
  }                                                                                           \
  ResidualEstimate residual_##T##_##Problem(const ContactBlock<T, Law>* b, std::size_t n,     \
                                            const BodyRecord<T>* v) {                         \
    return residual<T, Law, spin>(b, n, v);                                                   \
  }
#define DRUMLIN_KERNELS(Problem, Law, spin) \
  DRUMLIN_KERNELS_OF(double, Problem, Law, spin) DRUMLIN_KERNELS_OF(float, Problem, Law, spin)
DRUMLIN_EACH_DISC_PROBLEM(DRUMLIN_KERNELS)
#undef DRUMLIN_KERNELS
#undef DRUMLIN_KERNELS_OF

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

#define DRUMLIN_DISPATCH_OF(T, Problem, Law, spin)                                                        \
  HWY_EXPORT(load_##T##_##Problem);                                                                       \
  HWY_EXPORT(residual_##T##_##Problem);                                                                   \
  HWY_EXPORT(sweep_##T##_##Problem);                                                                      \
  template <>                                                                                             \
  void SweepKernels<T, Law, spin>::load(const Block* blocks, std::size_t count, BodyRecord<T>* bodies) {  \
    HWY_DYNAMIC_DISPATCH(load_##T##_##Problem)(blocks, count, bodies);                                    \
  }                                                                                                       \
  template <>                                                                                             \
  double SweepKernels<T, Law, spin>::sweep(Block* blocks, std::span<const std::int32_t> groups,           \
                                           BodyRecord<T>* bodies, T beta, SweepExtrapolation how) {       \
    return HWY_DYNAMIC_DISPATCH(sweep_##T##_##Problem)(blocks, groups, bodies, beta, how);                \
  }                                                                                                       \
  template <>                                                                                             \
  ResidualEstimate SweepKernels<T, Law, spin>::residual(const Block* blocks, std::size_t count,           \
                                                        const BodyRecord<T>* bodies) {                    \
    return HWY_DYNAMIC_DISPATCH(residual_##T##_##Problem)(blocks, count, bodies);                         \
  }                                                                                                       \
  template <>                                                                                             \
  void SweepKernels<T, Law, spin>::go_on(BodyRecord<T>* bodies, BodyRecord<T>* before, std::size_t count, \
                                         T beta) {                                                        \
    HWY_DYNAMIC_DISPATCH(go_on_##T)(bodies, before, count, beta);                                         \
  }
#define DRUMLIN_DISPATCH(Problem, Law, spin) \
  DRUMLIN_DISPATCH_OF(double, Problem, Law, spin) DRUMLIN_DISPATCH_OF(float, Problem, Law, spin)
DRUMLIN_EACH_DISC_PROBLEM(DRUMLIN_DISPATCH)
#undef DRUMLIN_DISPATCH
#undef DRUMLIN_DISPATCH_OF

}  // namespace drumlin::particles
#endif  // HWY_ONCE
