#pragma once
// W = H M^-1 H^T of discs, never assembled: a contact reads and writes the velocities of its two bodies.
// For discs W_nt = 0 and W_tt = 3 W_nn with spin (J = m r^2 / 2), W_tt = W_nn without.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/contact/sweep_plan.hpp"
#include "particles/contact_law/laws.hpp"
#include "particles/parallel/work_memory.hpp"

namespace drumlin::particles {

/// Velocity change of a body and what turns an impulse into it. With spin, `s` is r omega: the tangential
/// velocity of the rim, which the contacts need, in place of omega. Velocities stand first, so that a vector
/// of these is also a plain array of doubles on which linear combinations act (`inverse_mass` of a
/// combination is then zero or unused).
template <bool with_spin>
struct BodyVelocity;
template <>
struct BodyVelocity<true> {
  double x = 0, z = 0, s = 0, inverse_mass = 0;
};
template <>
struct BodyVelocity<false> {
  double x = 0, z = 0, inverse_mass = 0;
};

/// Contacts of discs in solve order. Body `bodies` is the fixed one that all walls share (inverse mass zero).
template <class Cone, bool with_spin>
class BodyDelassus {
 public:
  static constexpr int dim = Cone::dim;
  using Velocity = BodyVelocity<with_spin>;

  /// Impulses seen through the bodies: velocity changes M^-1 H^T r.
  using State = std::vector<Velocity>;

  std::vector<std::int32_t> i, j;    ///< bodies; the normal points from j to i
  std::vector<double> n_x, n_z;      ///< unit normal; the tangent is (n_z, -n_x)
  std::vector<double> inverse_W_nn;  ///< 1 / (1/m_i + 1/m_j)
  std::vector<double> inverse_mass;  ///< of each body, the fixed one last
  SweepPlan plan;  ///< of the contacts in their order; empty: a solver that needs one finds it

  int contacts() const { return static_cast<int>(i.size()); }
  std::int32_t fixed() const { return static_cast<std::int32_t>(inverse_mass.size()) - 1; }

  void add(std::int32_t body_i, std::int32_t body_j, double normal_x, double normal_z) {
    resize(i.size() + 1);
    set(contacts() - 1, body_i, body_j, normal_x, normal_z);
  }
  /// Makes room for contacts that are set one by one, in any order.
  void resize(std::size_t count) {
    i.resize(count), j.resize(count), n_x.resize(count), n_z.resize(count), inverse_W_nn.resize(count);
  }
  /// The same for contacts that are all set anew.
  void renew(std::size_t count) {
    resize_closely(i, count), resize_closely(j, count), resize_closely(n_x, count),
        resize_closely(n_z, count);
    resize_closely(inverse_W_nn, count);
  }
  void set(int a, std::int32_t body_i, std::int32_t body_j, double normal_x, double normal_z) {
    i[a] = body_i, j[a] = body_j, n_x[a] = normal_x, n_z[a] = normal_z;
    inverse_W_nn[a] = 1 / (inverse_mass[body_i] + inverse_mass[body_j]);
  }

  /// State at r = 0.
  void rest(State& state) const {
    state.assign(inverse_mass.size(), Velocity{});
    for (std::size_t b = 0; b < state.size(); ++b) state[b].inverse_mass = inverse_mass[b];
  }

  /// Adds the impulse dr of contact a to the state. `both`: to both bodies; threads that share the fixed one
  /// leave it alone.
  void push(State& state, int a, double dr_n, double dr_t, bool both = true) const {
    Velocity& I = state[i[a]];
    Velocity& J = state[j[a]];
    double p_x = n_x[a] * dr_n, p_z = n_z[a] * dr_n;
    if constexpr (dim == 2) {
      p_x += n_z[a] * dr_t;
      p_z -= n_x[a] * dr_t;
    }
    I.x += I.inverse_mass * p_x;
    I.z += I.inverse_mass * p_z;
    if constexpr (with_spin) I.s -= 2 * I.inverse_mass * dr_t;  // r J^-1 (-r r_t) = -2 r_t / m, for both
    if (!both) return;
    J.x -= J.inverse_mass * p_x;
    J.z -= J.inverse_mass * p_z;
    if constexpr (with_spin) J.s -= 2 * J.inverse_mass * dr_t;
  }

  double normal_velocity(const State& state, int a) const {
    const Velocity &I = state[i[a]], &J = state[j[a]];
    return n_x[a] * (I.x - J.x) + n_z[a] * (I.z - J.z);
  }
  double tangential_velocity(const State& state, int a) const {
    const Velocity &I = state[i[a]], &J = state[j[a]];
    double u = n_z[a] * (I.x - J.x) - n_x[a] * (I.z - J.z);
    if constexpr (with_spin) u -= I.s + J.s;
    return u;
  }

  /// lambda_max(W_aa), the scale of the residual, in parts of W_nn.
  static constexpr double largest_in_W_nn = dim == 2 && with_spin ? 3 : 1;
  double largest_eigenvalue(int a) const { return largest_in_W_nn / inverse_W_nn[a]; }

  /// State of given impulses, from scratch.
  void load(State& state, std::span<const double> r) const {
    rest(state);
    for (int a = 0; a < contacts(); ++a) push(state, a, r[dim * a], dim == 2 ? r[dim * a + 1] : 0);
  }

  /// The same on a team. Many contacts that are planned are added slice by slice, whatever the number of
  /// threads.
  void load(State& state, std::span<const double> r, const TeamLoops& loops) const {
    constexpr int many = 50'000;
    if (plan.empty() || contacts() < many)
      load(state, r);
    else
      load_by_slices(state, r, loops);
  }

  /// The same of contacts that are planned: first those of even slices, then the others.
  void load_by_slices(State& state, std::span<const double> r, const TeamLoops& loops) const {
    resize_closely(state, inverse_mass.size());
    loops.each(state.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        state[b] = {};
        state[b].inverse_mass = inverse_mass[b];
      }
    });
    const auto first = [&](int slice) { return plan.group_start[plan.slice_start[slice]]; };
    for (const int parity : {0, 1})
      loops.each_of(plan.strips(), [&](int strip) {
        const int slice = 2 * strip + parity;
        const int end = first(slice + 1);
        for (int a = first(slice); a < end; ++a)
          push(state, a, r[dim * a], dim == 2 ? r[dim * a + 1] : 0, j[a] != fixed());
      });
  }

  /// u = W r + q. `scratch` is overwritten.
  void velocities(std::span<const double> r, std::span<const double> q, State& scratch,
                  std::vector<double>& u) const {
    load(scratch, r);
    u.resize(q.size());
    velocities_of(0, contacts(), q, scratch, u);
  }
  /// The same of contacts `begin` to `end`, from a state that is loaded.
  void velocities_of(int begin, int end, std::span<const double> q, const State& state,
                     std::vector<double>& u) const {
    for (int a = begin; a < end; ++a) {
      u[dim * a] = q[dim * a] + normal_velocity(state, a);
      if constexpr (dim == 2) u[dim * a + 1] = q[dim * a + 1] + tangential_velocity(state, a);
    }
  }

  /// One Gauss-Seidel sweep in the order of the contacts: each is solved exactly with the others as they
  /// stand. r and state are updated, `step` receives r_new - r_old; returns the sum of squares of `step`.
  double sweep(std::span<const double> q, std::span<const double> mu, std::span<double> r, State& state,
               std::span<double> step) const {
    using namespace contact_law;
    double sum = 0;
    const int count = contacts();
    for (int a = 0; a < count; ++a) {
      InverseBlock<double, dim> W;
      std::array<double, dim> u;
      W.nn = inverse_W_nn[a], u[0] = q[dim * a] + normal_velocity(state, a);
      if constexpr (dim == 2) {
        W.tt = inverse_W_nn[a] * (1 / largest_in_W_nn);
        u[1] = q[2 * a + 1] + tangential_velocity(state, a);
      }
      const auto old = numbers_at<dim>(&r[dim * a]);
      const auto fresh = solved(W, numbers_at<dim - 1>(mu.data() + (dim - 1) * a), u, old);
      for (int c = 0; c < dim; ++c) {
        step[dim * a + c] = fresh[c] - old[c];
        r[dim * a + c] = fresh[c];
        sum += step[dim * a + c] * step[dim * a + c];
      }
      push(state, a, step[dim * a], dim == 2 ? step[dim * a + 1] : 0);
    }
    return sum;
  }

  /// The velocities of a state as one array of doubles; the inverse masses in it must not be changed.
  static std::span<double> numbers(State& state) {
    return {reinterpret_cast<double*>(state.data()), state.size() * (sizeof(Velocity) / sizeof(double))};
  }
};

}  // namespace drumlin::particles
