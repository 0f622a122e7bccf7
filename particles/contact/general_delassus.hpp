#pragma once
// W = H M^-1 H^T of discs with rolling resistance, of walls that contacts push, and of a cell under pressure.
// Scenes without these effects use BodyDelassus and pay nothing for them. Contact after contact, in the order
// of the problem.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "particles/contact/body_delassus.hpp"
#include "particles/contact_law/local_block.hpp"

namespace drumlin::particles {

/// A wall that moves along one direction, with a mass of its own; its velocity across is prescribed.
struct DrivenBody {
  double e_x = 0, e_z = 0;  ///< unit vector
  double inverse_mass = 0;
};

/// A periodic cell whose rates of strain answer contacts: it gives each the rate times its arm.
struct CellBody {
  double inverse_inertia_x = 0, inverse_inertia_z = 0;
  double length_x = 1, length_z = 1;
};

/// Contacts in solve order. Bodies: the grains, the fixed one, then the driven walls or the cell if
/// `with_driven`.
template <class Cone, bool with_spin, bool with_driven>
class GeneralDelassus {
 public:
  static constexpr int dim = Cone::dim;
  static constexpr bool has_driven = with_driven;
  static_assert(dim < 3 || with_spin, "rolling is a matter of spin");
  using Velocity = BodyVelocity<with_spin>;
  using State = std::vector<Velocity>;
  using Impulse = std::array<double, dim>;

  std::vector<std::int32_t> i, j;  ///< bodies; the normal points from j to i
  std::vector<double> n_x, n_z;
  std::vector<double> lever;         ///< R_eff / r_i = r_j / (r_i + r_j), 1 at a wall; empty without rolling
  std::vector<double> inverse_mass;  ///< of each body; 0 for the fixed one and the driven ones
  std::vector<DrivenBody> driven;
  std::optional<CellBody> cell;      ///< excludes driven walls
  std::vector<double> arm_x, arm_z;  ///< of contacts in a cell, from j to i; set before the contact
  SweepPlan plan;                    ///< of the contacts in their order

  int contacts() const { return static_cast<int>(i.size()); }
  std::int32_t fixed() const {
    return static_cast<std::int32_t>(inverse_mass.size() - driven.size() - cell.has_value()) - 1;
  }
  /// The driven wall of contact a, or none.
  const DrivenBody* driven_wall(int a) const {
    const std::int32_t k = j[a] - fixed() - 1;
    return k < 0 ? nullptr : &driven[k];
  }
  /// The cell's place among the bodies.
  std::int32_t cell_body() const { return fixed() + 1; }
  /// Whether contact a pushes more than its grains.
  bool pushes_more(int a) const { return cell || driven_wall(a) != nullptr; }

  /// Masses and driven walls must be there. `lever_i` without rolling: of no effect.
  void add(std::int32_t body_i, std::int32_t body_j, double normal_x, double normal_z, double lever_i = 1) {
    resize(i.size() + 1);
    set(contacts() - 1, body_i, body_j, normal_x, normal_z, lever_i);
  }
  /// Makes room for contacts that are set one by one, in any order.
  void renew(std::size_t count) { resize(count); }
  void resize(std::size_t count) {
    i.resize(count), j.resize(count), n_x.resize(count), n_z.resize(count), blocks_.resize(count);
    if constexpr (dim == 3) lever.resize(count);
    if (cell) arm_x.resize(count), arm_z.resize(count);
  }
  void set(int a, std::int32_t body_i, std::int32_t body_j, double normal_x, double normal_z,
           double lever_i = 1) {
    i[a] = body_i, j[a] = body_j, n_x[a] = normal_x, n_z[a] = normal_z;
    if constexpr (dim == 3) lever[a] = lever_i;
    blocks_[a] = block_of(a);
  }

  const LocalBlock<dim>& block(int a) const { return blocks_[a]; }

  void rest(State& state) const {
    state.assign(inverse_mass.size(), Velocity{});
    for (std::size_t b = 0; b < state.size(); ++b) state[b].inverse_mass = inverse_mass[b];
  }

  /// Adds the impulse dr of contact a to the state.
  void push(State& state, int a, const Impulse& dr) const {
    Velocity& I = state[i[a]];
    Velocity& J = state[j[a]];
    double p_x = n_x[a] * dr[0], p_z = n_z[a] * dr[0];
    if constexpr (dim >= 2) p_x += n_z[a] * dr[1], p_z -= n_x[a] * dr[1];
    I.x += I.inverse_mass * p_x;
    I.z += I.inverse_mass * p_z;
    J.x -= J.inverse_mass * p_x;
    J.z -= J.inverse_mass * p_z;
    if constexpr (with_spin && dim >= 2) {
      I.s -= 2 * I.inverse_mass * dr[1];
      J.s -= 2 * J.inverse_mass * dr[1];
    }
    if constexpr (dim == 3) {  // a torque R_eff r_r on i and its opposite on j: r R_eff / J = 2 lever / m
      I.s += 2 * I.inverse_mass * lever[a] * dr[2];
      J.s -= 2 * J.inverse_mass * (1 - lever[a]) * dr[2];
    }
    if constexpr (with_driven)
      if (const DrivenBody* wall = driven_wall(a)) {
        const double along = (p_x * wall->e_x + p_z * wall->e_z) * wall->inverse_mass;
        J.x -= along * wall->e_x, J.z -= along * wall->e_z;
      }
    if constexpr (with_driven)
      if (cell) {
        Velocity& rates = state[cell_body()];
        rates.x += cell->inverse_inertia_x * arm_x[a] * p_x;
        rates.z += cell->inverse_inertia_z * arm_z[a] * p_z;
      }
  }

  /// H v of the state: what contact a's bodies do to each other.
  Impulse relative_velocity(const State& state, int a) const {
    const Velocity &I = state[i[a]], &J = state[j[a]];
    double d_x = I.x - J.x, d_z = I.z - J.z;
    if constexpr (with_driven)
      if (cell) d_x += state[cell_body()].x * arm_x[a], d_z += state[cell_body()].z * arm_z[a];
    Impulse u{};
    u[0] = n_x[a] * d_x + n_z[a] * d_z;
    if constexpr (dim >= 2) u[1] = n_z[a] * d_x - n_x[a] * d_z;
    if constexpr (with_spin && dim >= 2) u[1] -= I.s + J.s;
    if constexpr (dim == 3) u[2] = lever[a] * I.s - (1 - lever[a]) * J.s;
    return u;
  }

  /// Sum of the sizes of what contacts give to driven walls, or of what crosses the cell under pressure.
  double driven_impulses(const State& state) const {
    double sum = 0;
    for (std::size_t k = 0; k < driven.size(); ++k) {
      const Velocity& wall = state[fixed() + 1 + k];
      sum += std::abs(wall.x * driven[k].e_x + wall.z * driven[k].e_z) / driven[k].inverse_mass;
    }
    if (!cell) return sum;
    const auto across = [](double rate, double inverse_inertia, double length) {
      return inverse_inertia > 0 ? std::abs(rate) / (inverse_inertia * length) : 0;
    };
    const Velocity& rates = state[cell_body()];
    return sum + across(rates.x, cell->inverse_inertia_x, cell->length_x) +
           across(rates.z, cell->inverse_inertia_z, cell->length_z);
  }

  /// lambda_max(W_aa), the scale of the residual.
  double largest_eigenvalue(int a) const { return particles::largest_eigenvalue<dim>(blocks_[a].matrix); }

  /// State of given impulses, from scratch.
  void load(State& state, std::span<const double> r) const {
    rest(state);
    for (int a = 0; a < contacts(); ++a) push(state, a, contact_law::numbers_at<dim>(&r[dim * a]));
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
      const Impulse own = relative_velocity(state, a);
      for (int c = 0; c < dim; ++c) u[dim * a + c] = q[dim * a + c] + own[c];
    }
  }

  /// One Gauss-Seidel sweep. `mu` holds dim - 1 coefficients per contact.
  double sweep(std::span<const double> q, std::span<const double> mu, std::span<double> r, State& state,
               std::span<double> step) const {
    double sum = 0;
    for (int a = 0; a < contacts(); ++a) {
      const Impulse old = contact_law::numbers_at<dim>(&r[dim * a]);
      Impulse u = relative_velocity(state, a), change;
      for (int c = 0; c < dim; ++c) u[c] += q[dim * a + c];
      const auto coefficients = contact_law::numbers_at<dim - 1>(mu.data() + (dim - 1) * a);
      const Impulse fresh = solved(blocks_[a], coefficients, u, old);
      for (int c = 0; c < dim; ++c) {
        change[c] = fresh[c] - old[c];
        r[dim * a + c] = fresh[c];
        step[dim * a + c] = change[c];
        sum += change[c] * change[c];
      }
      push(state, a, change);
    }
    return sum;
  }

  /// The velocities of a state as one array of doubles; the inverse masses in it must not be changed.
  static std::span<double> numbers(State& state) {
    return {reinterpret_cast<double*>(state.data()), state.size() * (sizeof(Velocity) / sizeof(double))};
  }

 private:
  LocalBlock<dim> block_of(int a) const {
    const double w_i = inverse_mass[i[a]], w_j = inverse_mass[j[a]], w = w_i + w_j;
    LocalMatrix W;
    W.nn = w, W.tt = with_spin ? 3 * w : w;
    if constexpr (dim == 3) {
      const double l_i = lever[a], l_j = 1 - l_i;
      W.tr = 2 * (l_j * w_j - l_i * w_i);
      W.rr = 2 * (l_i * l_i * w_i + l_j * l_j * w_j);
    }
    if constexpr (with_driven)
      if (const DrivenBody* wall = driven_wall(a)) {
        const double n = wall->e_x * n_x[a] + wall->e_z * n_z[a], t = wall->e_x * n_z[a] - wall->e_z * n_x[a];
        W.nn += n * n * wall->inverse_mass;
        W.nt += n * t * wall->inverse_mass;
        W.tt += t * t * wall->inverse_mass;
      }
    if constexpr (with_driven)
      if (cell) {
        const double x = arm_x[a] * arm_x[a] * cell->inverse_inertia_x,
                     z = arm_z[a] * arm_z[a] * cell->inverse_inertia_z;
        W.nn += n_x[a] * n_x[a] * x + n_z[a] * n_z[a] * z;
        W.nt += n_x[a] * n_z[a] * (x - z);
        W.tt += n_z[a] * n_z[a] * x + n_x[a] * n_x[a] * z;
      }
    return LocalBlock<dim>(W);
  }

  std::vector<LocalBlock<dim>> blocks_;
};

}  // namespace drumlin::particles
