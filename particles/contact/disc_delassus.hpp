#pragma once
// W = H M^-1 H^T of discs, never assembled: a contact reads and writes the velocities of its two bodies, and
// of the wall or the cell that it pushes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "particles/contact/coupled_bodies.hpp"
#include "particles/contact/sweep_plan.hpp"
#include "particles/contact_law/local_block.hpp"
#include "particles/parallel/work_memory.hpp"

namespace drumlin::particles {

/// Velocity change of a body, s = r omega that of its rim, and what turns an impulse into it. Velocities
/// stand first, so that a vector of these is also a plain array of doubles on which linear combinations act
/// (`inverse_mass` of a combination is then zero or unused).
struct BodyVelocity {
  double x = 0, z = 0, s = 0, inverse_mass = 0;
};

/// Contacts in solve order. Bodies: the grains, the fixed one that all other walls share, then the driven
/// walls or the cell. For discs W_nt = 0 and W_tt is tangential_gain times W_nn;
/// only driven walls and a cell add to that. `dim` unknowns per contact.
template <int dim_, bool with_spin>
class DiscDelassus {
 public:
  static constexpr int dim = dim_;
  static constexpr bool spin = with_spin;
  static_assert(dim < 3 || spin, "a couple turns discs");
  using Velocity = BodyVelocity;
  /// Impulses seen through the bodies: velocity changes M^-1 H^T r.
  using State = std::vector<Velocity>;
  using Impulse = ContactNumbers<dim>;

  std::vector<std::int32_t> i, j;    ///< bodies; the normal points from j to i
  std::vector<double> n_x, n_z;      ///< unit normal; the tangent is (n_z, -n_x)
  std::vector<double> radius_ratio;  ///< R_eff / r_i = r_j / (r_i + r_j), 1 at a wall; empty if dim < 3
  std::vector<double> inverse_W_nn;  ///< 1 / (1/m_i + 1/m_j), driven walls and the cell aside
  std::vector<double> inverse_mass;  ///< of each body; 0 for the fixed one and the driven ones
  std::vector<DrivenBody> driven;
  std::optional<CellBody> cell;      ///< excludes driven walls
  std::vector<double> arm_x, arm_z;  ///< of contacts in a cell, from j to i
  SweepPlan plan;  ///< of the contacts in their order; empty: a solver that needs one finds it

  int contacts() const { return static_cast<int>(i.size()); }
  /// Whether any body is pushed by more contacts than a grain has.
  bool coupled() const { return cell || !driven.empty(); }
  std::int32_t fixed() const {
    return static_cast<std::int32_t>(inverse_mass.size() - driven.size() - cell.has_value()) - 1;
  }
  /// The driven wall of contact a, or none.
  const DrivenBody* driven_wall(int a) const {
    const std::int32_t k = j[a] - fixed() - 1;
    return k < 0 ? nullptr : &driven[k];
  }
  /// The cell's position among the bodies.
  std::int32_t cell_body() const { return fixed() + 1; }
  /// Whether contact a pushes more than its grains.
  bool pushes_more(int a) const { return cell || driven_wall(a) != nullptr; }

  /// Masses must be there. `radius_ratio_i` if dim < 3: of no effect.
  void add(std::int32_t body_i, std::int32_t body_j, double normal_x, double normal_z,
           double radius_ratio_i = 1) {
    resize(i.size() + 1);
    set(contacts() - 1, body_i, body_j, normal_x, normal_z, radius_ratio_i);
  }
  /// Makes room for contacts that are set one by one, in any order. A cell must be there.
  void resize(std::size_t count) {
    each_array([count](auto& array) { array.resize(count); });
  }
  /// The same for contacts that are all set anew.
  void resize_uninitialized(std::size_t count) {
    each_array([count](auto& array) { resize_closely(array, count); });
  }
  void set(int a, std::int32_t body_i, std::int32_t body_j, double normal_x, double normal_z,
           double radius_ratio_i = 1) {
    i[a] = body_i, j[a] = body_j, n_x[a] = normal_x, n_z[a] = normal_z;
    inverse_W_nn[a] = 1 / (inverse_mass[body_i] + inverse_mass[body_j]);
    if constexpr (dim == 3) radius_ratio[a] = radius_ratio_i;
  }

  /// State at r = 0.
  void rest(State& state) const { rest(state, ParallelLoops()); }

  /// Adds the impulse dr of contact a to its bodies I and J, J the driven wall of a contact with one, and to
  /// the rates of the cell, if there is one.
  template <class Body>
  void push(int a, const Impulse& dr, Body& I, Body& J, Body* rates) const {
    const auto at = frame(a);
    contact_law::push<spin>(at, dr, I, J);
    if (!coupled()) return;
    const auto p = contact_law::impulse_vector(at, dr);
    if (const DrivenBody* wall = cell ? nullptr : driven_wall(a)) wall->push(p, J);
    if (cell) cell->push(p, arm_x[a], arm_z[a], *rates);
  }
  /// The same to the state. The fixed body, which threads share, is left alone.
  void push(State& state, int a, const Impulse& dr) const {
    Velocity still{};
    push(a, dr, state[i[a]], j[a] == fixed() ? still : state[j[a]], cell ? &state[cell_body()] : nullptr);
  }

  /// H v: what contact a's bodies do to each other.
  template <class Body>
  Impulse relative_velocity(int a, const Body& I, const Body& J, const Body* rates) const {
    double d_x = I.x - J.x, d_z = I.z - J.z;
    if (cell) d_x += rates->x * arm_x[a], d_z += rates->z * arm_z[a];
    return contact_law::relative_velocity<spin, dim>(frame(a), d_x, d_z, I, J);
  }
  Impulse relative_velocity(const State& state, int a) const {
    return relative_velocity(a, state[i[a]], state[j[a]], cell ? &state[cell_body()] : nullptr);
  }

  /// W_aa.
  LocalBlock<dim> block(int a) const {
    const double w_i = inverse_mass[i[a]], w_j = inverse_mass[j[a]], w = w_i + w_j;
    LocalMatrix W{w, 0, tangential_gain<spin> * w};
    if constexpr (dim == 3) {
      const double l_i = radius_ratio[a], l_j = 1 - l_i;
      W.tr = surface_gain * (l_j * w_j - l_i * w_i);
      W.rr = surface_gain * (l_i * l_i * w_i + l_j * l_j * w_j);
    }
    if (cell) {
      const double x = arm_x[a] * arm_x[a] * cell->inverse_inertia_x,
                   z = arm_z[a] * arm_z[a] * cell->inverse_inertia_z;
      W.nn += n_x[a] * n_x[a] * x + n_z[a] * n_z[a] * z;
      W.nt += n_x[a] * n_z[a] * (x - z);
      W.tt += n_z[a] * n_z[a] * x + n_x[a] * n_x[a] * z;
    } else if (const DrivenBody* wall = driven_wall(a)) {
      const double n = wall->e_x * n_x[a] + wall->e_z * n_z[a], t = wall->e_x * n_z[a] - wall->e_z * n_x[a];
      W.nn += n * n * wall->inverse_mass;
      W.nt += n * t * wall->inverse_mass;
      W.tt += t * t * wall->inverse_mass;
    }
    return LocalBlock<dim>(W);
  }

  /// lambda_max(W_aa), the scale of the residual; of contacts without couples that push grains alone in parts
  /// of W_nn.
  static constexpr double largest_in_W_nn = tangential_gain<(dim == 2 && spin)>;
  double largest_eigenvalue(int a) const {
    if (dim < 3 && !(coupled() && pushes_more(a))) return largest_in_W_nn / inverse_W_nn[a];
    return particles::largest_eigenvalue<dim>(block(a).matrix);
  }

  /// Contact a solved with the others as they stand: u are the velocities that belong to its impulses r.
  template <class Law>
  Impulse solved(Law law, int a, const contact_law::Coefficients<double, Law>& mu, const Impulse& u,
                 const Impulse& r) const {
    if (dim == 3 || (coupled() && pushes_more(a))) return particles::solved(law, block(a), mu, u, r);
    contact_law::InverseBlock<double, dim> W{};
    W.nn = inverse_W_nn[a];
    if constexpr (dim >= 2) W.tt = W.nn * (1 / largest_in_W_nn);
    return contact_law::solved(law, W, mu, u, r);
  }

  /// Sum of the sizes of what contacts give to driven walls, or of what crosses the cell under pressure.
  double driven_impulses(const State& state) const {
    double sum = 0;
    for (std::size_t k = 0; k < driven.size(); ++k) {
      const Velocity& wall = state[fixed() + 1 + k];
      sum += std::abs(wall.x * driven[k].e_x + wall.z * driven[k].e_z) / driven[k].inverse_mass;
    }
    return cell ? sum + cell->impulses(state[cell_body()]) : sum;
  }

  /// State of given impulses, from scratch. Many contacts that are planned are added slice by slice, whatever
  /// the number of threads.
  void load(State& state, std::span<const double> r, const ParallelLoops& loops = ParallelLoops()) const {
    constexpr int many = 50'000;
    if (!plan.empty() && contacts() >= many && dim < 3 && !coupled()) return load_by_slices(state, r, loops);
    rest(state);
    for (int a = 0; a < contacts(); ++a) push(state, a, contact_law::numbers_at<dim>(&r[dim * a]));
  }

  /// The same of contacts that are planned: first those of even slices, then the others.
  void load_by_slices(State& state, std::span<const double> r, const ParallelLoops& loops) const {
    rest(state, loops);
    const auto first = [&](int slice) { return plan.group_start[plan.slice_start[slice]]; };
    for (const int parity : {0, 1})
      loops.each_of(plan.strips(), [&](int strip) {
        const int slice = 2 * strip + parity;
        const int end = first(slice + 1);
        for (int a = first(slice); a < end; ++a) push(state, a, contact_law::numbers_at<dim>(&r[dim * a]));
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
      const Impulse own = relative_velocity(state, a);
      for (int c = 0; c < dim; ++c) u[dim * a + c] = q[dim * a + c] + own[c];
    }
  }

  /// The velocities of a state as one array of doubles; the inverse masses in it must not be changed.
  static std::span<double> numbers(State& state) {
    return {reinterpret_cast<double*>(state.data()), state.size() * (sizeof(Velocity) / sizeof(double))};
  }

 private:
  contact_law::ContactFrame<double> frame(int a) const {
    return {n_x[a], n_z[a], dim == 3 ? radius_ratio[a] : 1};
  }
  template <class Each>
  void each_array(Each each) {
    each(i), each(j), each(n_x), each(n_z), each(inverse_W_nn);
    if constexpr (dim == 3) each(radius_ratio);
    if (cell) each(arm_x), each(arm_z);
  }
  void rest(State& state, const ParallelLoops& loops) const {
    resize_closely(state, inverse_mass.size());
    loops.each(state.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) state[b] = {0, 0, 0, inverse_mass[b]};
    });
  }
};

}  // namespace drumlin::particles
