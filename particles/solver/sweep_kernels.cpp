// Compiled once for each instruction set: foreach_target.h includes this file again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "particles/solver/sweep_kernels.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include <utility>

#include "particles/contact/cone_vectors-inl.h"
#include "particles/solver/body_vectors-inl.h"
#include "particles/solver/sweep_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace drumlin::particles::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// What a couple R_eff r_r changes of the rims of i and j, per r_r; their difference is W_tr.
template <class V>
struct Turns {
  V i, j;
};
template <class T, class V>
HWY_INLINE Turns<V> turns_of(V lever, const BodyVectors<T>& I, const BodyVectors<T>& J) {
  const V other = hn::Sub(hn::Set(Lanes<T>(), T(1)), lever);
  return {hn::Mul(hn::Add(I.inverse_mass, I.inverse_mass), lever),
          hn::Mul(hn::Add(J.inverse_mass, J.inverse_mass), other)};
}

/// lever s_i - (1 - lever) s_j.
template <class T, class V>
HWY_INLINE V rolling_velocity(V lever, const BodyVectors<T>& I, const BodyVectors<T>& J) {
  const V other = hn::Sub(hn::Set(Lanes<T>(), T(1)), lever);
  return hn::Sub(hn::Mul(lever, I.s), hn::Mul(other, J.s));
}

/// Adds impulses (n, t) of contacts to their bodies.
template <int dim, bool spin, class T, class V>
HWY_INLINE void push(V n_x, V n_z, V n, V t, BodyVectors<T>& I, BodyVectors<T>& J) {
  V p_x = hn::Mul(n_x, n), p_z = hn::Mul(n_z, n);
  if constexpr (dim >= 2) {
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

/// Adds the couples of rolling resistance: R_eff r_r on i and its opposite on j.
template <class T, class V>
HWY_INLINE void roll(V lever, V r, BodyVectors<T>& I, BodyVectors<T>& J) {
  const auto turns = turns_of<T>(lever, I, J);
  I.s = hn::Add(I.s, hn::Mul(turns.i, r));
  J.s = hn::Sub(J.s, hn::Mul(turns.j, r));
}

template <class T, int dim, bool spin>
void load(const ContactBlock<T, dim>* blocks, std::size_t count, BodyRecord<T>* bodies) {
  const Lanes<T> d;
  constexpr int width = ContactBlock<T, dim>::width;
  for (std::size_t b = 0; b < count; ++b) {
    const auto& block = blocks[b];
    for (std::size_t k = 0; k < width; k += hn::Lanes(d)) {
      auto I = load_bodies(bodies, &block.i[k]), J = load_bodies(bodies, &block.j[k]);
      const auto n = hn::Load(d, &block.r[0][k]), t = dim >= 2 ? hn::Load(d, &block.r[dim >= 2][k]) : n;
      push<dim, spin, T>(hn::Load(d, &block.n_x[k]), hn::Load(d, &block.n_z[k]), n, t, I, J);
      if constexpr (dim == 3) roll<T>(hn::Load(d, &block.lever[k]), hn::Load(d, &block.r[2][k]), I, J);
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

/// What a contact gives its bodies, which have gone on by themselves: its step, and what its start rounded
/// off.
template <SweepExtrapolation how, class V>
HWY_INLINE V given(V step, const Started<V>& start) {
  return how == SweepExtrapolation::exact ? hn::Add(step, start.rounded_off) : step;
}

/// A vector of contacts: those of a block from k on.
template <class T, int dim>
struct Place {
  ContactBlock<T, dim>* block;
  std::size_t k;
};

/// What a sweep knows of a vector of contacts.
template <class T>
struct SweptContacts {
  BodyVectors<T> I, J;
  hn::Vec<Lanes<T>> dv_x, dv_z, new_n, dr_n, dr_t, squares;
};

/// What sweeps start from in this direction, with nothing stored.
template <SweepExtrapolation how, class T, int dim, class V>
HWY_INLINE V start_of(const Place<T, dim>& at, int e, V beta) {
  const Lanes<T> d;
  const V now = hn::Load(d, &at.block->r[e][at.k]);
  if constexpr (how == SweepExtrapolation::none) return now;
  return hn::Add(now, hn::Mul(beta, hn::Sub(now, hn::Load(d, &at.block->before[e][at.k]))));
}

/// Relative velocities of the rims of contacts.
template <class T, int dim, bool spin>
HWY_INLINE auto slip_of(const Place<T, dim>& at, const SweptContacts<T>& c) {
  const Lanes<T> d;
  auto& [block, k] = at;
  auto slip =
      hn::Sub(hn::Mul(hn::Load(d, &block->n_z[k]), c.dv_x), hn::Mul(hn::Load(d, &block->n_x[k]), c.dv_z));
  if constexpr (spin) slip = hn::Sub(slip, hn::Add(c.I.s, c.J.s));
  return slip;
}

/// W_nn of contacts some of which are steep, inverse, times the part of the way that their normal impulses go
/// from `n` with a velocity u_n.
template <class T, int dim, bool spin, SweepExtrapolation how, class V>
HWY_INLINE V steep_inverse_W_nn(const Place<T, dim>& at, V n, V u_n, V beta, const SweptContacts<T>& c) {
  const Lanes<T> d;
  auto& [block, k] = at;
  const V inverse = hn::Load(d, &block->inverse_W_nn[k]), third = hn::Set(d, spin ? T(1) / T(3) : T(1));
  const V whole = hn::Max(hn::Zero(d), hn::Sub(n, hn::Mul(u_n, inverse)));
  const V u_t = hn::Add(hn::Load(d, &block->q[1][k]), slip_of<T, dim, spin>(at, c));
  const V t = start_of<how>(at, 1, beta), free = hn::Sub(t, hn::Mul(u_t, hn::Mul(inverse, third)));
  V share = share_of_way(hn::Load(d, &block->mu[k]), n, t, whole, free);
  if constexpr (dim == 3) {
    const V u_r =
        hn::Add(hn::Load(d, &block->q[2][k]), rolling_velocity<T>(hn::Load(d, &block->lever[k]), c.I, c.J));
    const V r = start_of<how>(at, 2, beta), rolled = hn::Mul(u_r, hn::Load(d, &block->inverse_W_rr[k]));
    share = hn::Min(share, share_of_way(hn::Load(d, &block->mu_r[k]), n, r, whole, hn::Sub(r, rolled)));
  }
  return hn::Mul(inverse, share);
}

template <class T, int dim, bool spin, SweepExtrapolation how, class V>
HWY_INLINE void solve_normals(const Place<T, dim>& at, V beta, SweptContacts<T>& c) {
  const Lanes<T> d;
  auto& [block, k] = at;
  c.dv_x = hn::Sub(c.I.x, c.J.x), c.dv_z = hn::Sub(c.I.z, c.J.z);
  const V n_x = hn::Load(d, &block->n_x[k]), n_z = hn::Load(d, &block->n_z[k]);
  const auto start = started_from<how>(block->r[0], block->before[0], k, beta);
  const V approach = hn::Add(hn::Mul(n_x, c.dv_x), hn::Mul(n_z, c.dv_z));
  const V u_n = hn::Add(hn::Load(d, &block->q[0][k]), approach);
  V inverse = hn::Load(d, &block->inverse_W_nn[k]);
  if constexpr (dim >= 2) {
    V mu = hn::Load(d, &block->mu[k]);
    if constexpr (dim == 3) mu = hn::Max(mu, hn::Load(d, &block->mu_r[k]));
    if (any_steep(mu)) inverse = steep_inverse_W_nn<T, dim, spin, how>(at, start.r, u_n, beta, c);
  }
  // Max(a, NaN) is NaN, Max(NaN, a) is not.
  c.new_n = hn::Max(hn::Zero(d), hn::Sub(start.r, hn::Mul(u_n, inverse)));
  const V step = hn::Sub(c.new_n, start.r);
  c.dr_n = given<how>(step, start);
  hn::Store(c.new_n, d, &block->r[0][k]);
  c.squares = hn::Mul(step, step);
  c.dr_t = hn::Zero(d);
}

/// Friction r_t and rolling of contacts with tangential velocities u_t: the minimum over a box, exactly.
/// Friction as if rolling were free, clamped; rolling for that; friction for that. Returns the new r_t.
template <class T, SweepExtrapolation how, class V>
HWY_INLINE V solve_rolling(const Place<T, 3>& at, V beta, V r_t, V u_t, V bound, V inverse_W_tt,
                           SweptContacts<T>& c) {
  const Lanes<T> d;
  auto& [block, k] = at;
  const auto start = started_from<how>(block->r[2], block->before[2], k, beta);
  const V lever = hn::Load(d, &block->lever[k]), inverse_W_rr = hn::Load(d, &block->inverse_W_rr[k]);
  const auto turns = turns_of<T>(lever, c.I, c.J);
  const V W_tr = hn::Sub(turns.j, turns.i);
  const V u_r = hn::Add(hn::Load(d, &block->q[2][k]), rolling_velocity<T>(lever, c.I, c.J));
  const V pulled = hn::Sub(u_t, hn::Mul(W_tr, hn::Mul(inverse_W_rr, u_r)));
  const V first = clamped(hn::Sub(r_t, hn::Mul(pulled, hn::Load(d, &block->inverse_W_tt[k]))), bound);
  const V rolled = hn::Mul(inverse_W_rr, hn::Add(u_r, hn::Mul(W_tr, hn::Sub(first, r_t))));
  const V new_r = clamped(hn::Sub(start.r, rolled), hn::Mul(hn::Load(d, &block->mu_r[k]), c.new_n));
  const V step = hn::Sub(new_r, start.r), dr_r = given<how>(step, start);
  hn::Store(new_r, d, &block->r[2][k]);
  c.squares = hn::Add(c.squares, hn::Mul(step, step));
  roll<T>(lever, dr_r, c.I, c.J);
  return clamped(hn::Sub(r_t, hn::Mul(inverse_W_tt, hn::Add(u_t, hn::Mul(W_tr, dr_r)))), bound);
}

template <class T, int dim, bool spin, SweepExtrapolation how, class V>
HWY_INLINE void solve_tangents(const Place<T, dim>& at, V beta, SweptContacts<T>& c) {
  const Lanes<T> d;
  auto& [block, k] = at;
  const V ratio = hn::Set(d, spin ? T(1) / T(3) : T(1));  // W_nn / W_tt
  const auto start = started_from<how>(block->r[1], block->before[1], k, beta);
  const V u_t = hn::Add(hn::Load(d, &block->q[1][k]), slip_of<T, dim, spin>(at, c));
  const V bound = hn::Mul(hn::Load(d, &block->mu[k]), c.new_n);
  const V inverse_W_tt = hn::Mul(hn::Load(d, &block->inverse_W_nn[k]), ratio);
  V new_t;
  if constexpr (dim == 2)
    new_t = clamped(hn::Sub(start.r, hn::Mul(u_t, inverse_W_tt)), bound);
  else
    new_t = solve_rolling<T, how>(at, beta, start.r, u_t, bound, inverse_W_tt, c);
  const V step = hn::Sub(new_t, start.r);
  c.dr_t = given<how>(step, start);
  hn::Store(new_t, d, &block->r[1][k]);
  c.squares = hn::Add(c.squares, hn::Mul(step, step));
}

template <class T, int dim>
HWY_INLINE void bring_bodies(const Place<T, dim>& at, const BodyRecord<T>* bodies, SweptContacts<T>& c) {
  c.I = load_bodies(bodies, &at.block->i[at.k]);
  c.J = load_bodies(bodies, &at.block->j[at.k]);
}

template <class T, int dim, bool spin>
HWY_INLINE void push_bodies(const Place<T, dim>& at, SweptContacts<T>& c, BodyRecord<T>* bodies) {
  const Lanes<T> d;
  auto& [block, k] = at;
  push<dim, spin, T>(hn::Load(d, &block->n_x[k]), hn::Load(d, &block->n_z[k]), c.dr_n, c.dr_t, c.I, c.J);
  store_bodies(c.I, bodies, &block->i[k]);
  store_bodies(c.J, bodies, &block->j[k]);
}

template <class T, int dim, bool spin, SweepExtrapolation how>
double sweep(ContactBlock<T, dim>* blocks, std::span<const std::int32_t> groups, BodyRecord<T>* bodies,
             T beta_) {
  const Lanes<T> d;
  constexpr std::size_t width = ContactBlock<T, dim>::width;
  const std::size_t lanes = hn::Lanes(d);
  const auto beta = hn::Set(d, beta_);
  // Eight sums whatever the length of a vector.
  HWY_ALIGN std::array<T, width> squares{};
  const auto solve = [&](const Place<T, dim>& at, SweptContacts<T>& c) HWY_ATTR {
    solve_normals<T, dim, spin, how>(at, beta, c);
    if constexpr (dim >= 2) solve_tangents<T, dim, spin, how>(at, beta, c);
    hn::Store(hn::Add(hn::Load(d, &squares[at.k]), c.squares), d, &squares[at.k]);
  };
  for (const std::int32_t count : groups) {
    if (count == 0) continue;
    ContactBlock<T, dim>* const first = std::exchange(blocks, blocks + count);
    // The chain of operations of one vector is longer than what a processor looks ahead: the bodies of the
    // next one come while this one's are pushed.
    Place<T, dim> at{first, 0};
    SweptContacts<T> c, next;
    bring_bodies(at, bodies, c);
    for (std::size_t left = count * (width / lanes) - 1; left > 0; --left) {
      solve(at, c);
      const bool whole = at.k + lanes == width;
      const Place<T, dim> after{whole ? at.block + 1 : at.block, whole ? 0 : at.k + lanes};
      bring_bodies(after, bodies, next);
      push_bodies<T, dim, spin>(at, c, bodies);
      at = after;
      c.I = next.I, c.J = next.J;
    }
    solve(at, c);
    push_bodies<T, dim, spin>(at, c, bodies);
  }
  return total(squares);
}

template <class T, int dim, bool spin>
double sweep(ContactBlock<T, dim>* blocks, std::span<const std::int32_t> groups, BodyRecord<T>* bodies,
             T beta, SweepExtrapolation how) {
  using enum SweepExtrapolation;
  if (how == none) return sweep<T, dim, spin, none>(blocks, groups, bodies, beta);
  if constexpr (sizeof(T) < sizeof(double))
    if (how == exact) return sweep<T, dim, spin, exact>(blocks, groups, bodies, beta);
  return sweep<T, dim, spin, rounded>(blocks, groups, bodies, beta);
}

/// 1 / lambda_max(W_aa) with rolling resistance: the larger eigenvalue of friction and rolling, W_nn being
/// below W_tt = 3 W_nn.
template <class T, class V>
HWY_INLINE V inverse_eigenvalue(V lever, const BodyVectors<T>& I, const BodyVectors<T>& J) {
  const Lanes<T> d;
  const V w = hn::Add(I.inverse_mass, J.inverse_mass), half = hn::Set(d, T(0.5)), one = hn::Set(d, T(1));
  const auto turns = turns_of<T>(lever, I, J);
  const V W_tt = hn::Add(w, hn::Add(w, w)), W_tr = hn::Sub(turns.j, turns.i);
  const V W_rr = hn::Add(hn::Mul(lever, turns.i), hn::Mul(hn::Sub(one, lever), turns.j));
  const V mean = hn::Mul(half, hn::Add(W_tt, W_rr)), off = hn::Mul(half, hn::Sub(W_tt, W_rr));
  const V largest = hn::Add(mean, hn::Sqrt(hn::Add(hn::Mul(off, off), hn::Mul(W_tr, W_tr))));
  // Places that are filled up have none.
  return hn::Div(one, hn::Max(largest, hn::Set(d, T(1e-15))));
}

template <class T, int dim, bool spin>
SeenResidual residual(const ContactBlock<T, dim>* blocks, std::size_t count, const BodyRecord<T>* bodies) {
  const Lanes<T> d;
  using V = hn::Vec<Lanes<T>>;
  constexpr int width = ContactBlock<T, dim>::width;
  const V zero = hn::Zero(d);
  const V ratio = hn::Set(d, dim == 2 && spin ? T(1) / T(3) : T(1));  // W_nn / lambda_max
  HWY_ALIGN std::array<T, width> squares{};
  HWY_ALIGN std::array<T, width> let_through{};
  HWY_ALIGN std::array<T, width> lowest_u_n{};
  for (std::size_t b = 0; b < count; ++b) {
    const auto& block = blocks[b];
    for (std::size_t k = 0; k < width; k += hn::Lanes(d)) {
      const auto I = load_bodies(bodies, &block.i[k]), J = load_bodies(bodies, &block.j[k]);
      const V n_x = hn::Load(d, &block.n_x[k]), n_z = hn::Load(d, &block.n_z[k]);
      V rho = hn::Mul(hn::Load(d, &block.inverse_W_nn[k]), ratio);
      const V dv_x = hn::Sub(I.x, J.x), dv_z = hn::Sub(I.z, J.z);
      const V r_n = hn::Load(d, &block.r[0][k]);
      const V u_n = hn::Add(hn::Load(d, &block.q[0][k]), hn::Add(hn::Mul(n_x, dv_x), hn::Mul(n_z, dv_z)));
      const V closing = hn::Min(zero, u_n);
      hn::Store(hn::Sub(hn::Load(d, &let_through[k]), hn::Mul(r_n, closing)), d, &let_through[k]);
      hn::Store(hn::Min(hn::Load(d, &lowest_u_n[k]), closing), d, &lowest_u_n[k]);
      V sum;
      if constexpr (dim == 1) {
        const V missed = hn::Sub(hn::Max(zero, hn::Sub(r_n, hn::Mul(rho, u_n))), r_n);
        sum = hn::Mul(missed, missed);
      } else {
        V slip = hn::Sub(hn::Mul(n_z, dv_x), hn::Mul(n_x, dv_z));
        if constexpr (spin) slip = hn::Sub(slip, hn::Add(I.s, J.s));
        const V u_t = hn::Add(hn::Load(d, &block.q[dim >= 2][k]), slip);
        const V mu = hn::Load(d, &block.mu[k]), r_t = hn::Load(d, &block.r[dim >= 2][k]);
        const V shifted = hn::Add(u_n, hn::Mul(mu, hn::Abs(u_t)));  // De Saxce
        if constexpr (dim == 2) {
          const V n = hn::Sub(r_n, hn::Mul(rho, shifted)), t = hn::Sub(r_t, hn::Mul(rho, u_t));
          sum = missed_by_projection(mu, n, t, r_n, r_t);
          if (any_steep(mu)) {
            const V in_turn = missed_in_turn(mu, hn::Sub(r_n, hn::Mul(rho, u_n)), t, r_n, r_t);
            sum = hn::IfThenElse(hn::Gt(mu, hn::Set(d, steep_friction)), in_turn, sum);
          }
        } else {
          const V lever = hn::Load(d, &block.lever[k]), mu_r = hn::Load(d, &block.mu_r[k]);
          const V r_r = hn::Load(d, &block.r[2][k]);
          const V u_r = hn::Add(hn::Load(d, &block.q[2][k]), rolling_velocity<T>(lever, I, J));
          rho = inverse_eigenvalue<T>(lever, I, J);
          const V n = hn::Sub(r_n, hn::Mul(rho, hn::Add(shifted, hn::Mul(mu_r, hn::Abs(u_r)))));
          const V t = hn::Sub(r_t, hn::Mul(rho, u_t)), roll = hn::Sub(r_r, hn::Mul(rho, u_r));
          sum = missed_by_projection(mu, mu_r, n, t, roll, r_n, r_t, r_r);
          if (const V larger = hn::Max(mu, mu_r); any_steep(larger)) {
            const V alone = hn::Sub(r_n, hn::Mul(rho, u_n));
            const V missed_r = hn::Sub(clamped(roll, hn::Mul(mu_r, positive_part(alone))), r_r);
            const V in_turn = hn::Add(missed_in_turn(mu, alone, t, r_n, r_t), hn::Mul(missed_r, missed_r));
            sum = hn::IfThenElse(hn::Gt(larger, hn::Set(d, steep_friction)), in_turn, sum);
          }
        }
      }
      sum = hn::Div(sum, hn::Mul(rho, rho));
      hn::Store(hn::Add(hn::Load(d, &squares[k]), sum), d, &squares[k]);
    }
  }
  return {total(squares), total(let_through), *std::min_element(lowest_u_n.begin(), lowest_u_n.end())};
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
  if (count == 0) return;  // a rank without bodies has no records either
  // Inverse masses stand still: their difference is zero.
  const std::size_t most = go_on(Lanes<T>(), &bodies->x, &before->x, 0, 4 * count, beta);
  const hn::CappedTag<T, 4> of_a_record;
  go_on(of_a_record, &bodies->x, &before->x, most, 4 * count, beta);
}

#define DRUMLIN_KERNELS(T, name, dim, spin)                                                            \
  void load_##name(const ContactBlock<T, dim>* b, std::size_t n, BodyRecord<T>* v) {                   \
    load<T, dim, spin>(b, n, v);                                                                       \
  }                                                                                                    \
  double sweep_##name(ContactBlock<T, dim>* b, std::span<const std::int32_t> groups, BodyRecord<T>* v, \
                      T beta, SweepExtrapolation how) {                                                \
    return sweep<T, dim, spin>(b, groups, v, beta, how);                                               \
  }                                                                                                    \
  SeenResidual residual_##name(const ContactBlock<T, dim>* b, std::size_t n, const BodyRecord<T>* v) { \
    return residual<T, dim, spin>(b, n, v);                                                            \
  }
DRUMLIN_KERNELS(double, double_smooth, 1, false)
DRUMLIN_KERNELS(double, double_friction, 2, false)
DRUMLIN_KERNELS(double, double_spin, 2, true)
DRUMLIN_KERNELS(double, double_rolling, 3, true)
DRUMLIN_KERNELS(float, float_smooth, 1, false)
DRUMLIN_KERNELS(float, float_friction, 2, false)
DRUMLIN_KERNELS(float, float_spin, 2, true)
DRUMLIN_KERNELS(float, float_rolling, 3, true)
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

#define DRUMLIN_DISPATCH(T, precision, name, dim, spin)                                                   \
  HWY_EXPORT(load_##name);                                                                                \
  HWY_EXPORT(residual_##name);                                                                            \
  HWY_EXPORT(sweep_##name);                                                                               \
  template <>                                                                                             \
  void SweepKernels<T, dim, spin>::load(const Block* blocks, std::size_t count, BodyRecord<T>* bodies) {  \
    HWY_DYNAMIC_DISPATCH(load_##name)(blocks, count, bodies);                                             \
  }                                                                                                       \
  template <>                                                                                             \
  double SweepKernels<T, dim, spin>::sweep(Block* blocks, std::span<const std::int32_t> groups,           \
                                           BodyRecord<T>* bodies, T beta, SweepExtrapolation how) {       \
    return HWY_DYNAMIC_DISPATCH(sweep_##name)(blocks, groups, bodies, beta, how);                         \
  }                                                                                                       \
  template <>                                                                                             \
  SeenResidual SweepKernels<T, dim, spin>::residual(const Block* blocks, std::size_t count,               \
                                                    const BodyRecord<T>* bodies) {                        \
    return HWY_DYNAMIC_DISPATCH(residual_##name)(blocks, count, bodies);                                  \
  }                                                                                                       \
  template <>                                                                                             \
  void SweepKernels<T, dim, spin>::go_on(BodyRecord<T>* bodies, BodyRecord<T>* before, std::size_t count, \
                                         T beta) {                                                        \
    HWY_DYNAMIC_DISPATCH(go_on_##precision)(bodies, before, count, beta);                                 \
  }
DRUMLIN_DISPATCH(double, double, double_smooth, 1, false)
DRUMLIN_DISPATCH(double, double, double_friction, 2, false)
DRUMLIN_DISPATCH(double, double, double_spin, 2, true)
DRUMLIN_DISPATCH(double, double, double_rolling, 3, true)
DRUMLIN_DISPATCH(float, float, float_smooth, 1, false)
DRUMLIN_DISPATCH(float, float, float_friction, 2, false)
DRUMLIN_DISPATCH(float, float, float_spin, 2, true)
DRUMLIN_DISPATCH(float, float, float_rolling, 3, true)
#undef DRUMLIN_DISPATCH

}  // namespace drumlin::particles
#endif  // HWY_ONCE
