#pragma once
// Coarse correction of the impulses of a large packing: a smooth field scales them, so that what they carry
// balances over long distances, which sweeps settle last.
//
// r_a becomes (1 + s(x_a)) r_a with s = sum_k s_k phi_k, phi_k bilinear on square cells: every impulse stays
// in its cone. At a solution no contact does work, but for the friction of those that slide,
//   g_a = r_n u_n + r_t u_t (+ mu r_n |u_t| where |r_t| = mu r_n) = 0;
// the field makes its weighted sums vanish, |u_t| as it stands (a Galerkin step):
//   sum_l A_kl s_l = - sum_a phi_k(x_a) g_a,  A_kl = (phi_k r) . W (phi_l r).
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/contact/sweep_plan.hpp"
#include "particles/parallel/team_loops.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/solver/coarse_field.hpp"

namespace drumlin::particles {

/// Where the bodies of a contact problem are, in any unit; empty where nobody knows.
struct BodyPlaces {
  std::span<const double> x, z;
};

/// Problems of fewer contacts are left to the sweeps.
inline constexpr int least_contacts_of_coarse_loads = 100000;
/// Sweeps between two corrections.
inline constexpr int sweeps_between_coarse_loads = 40;

/// What the correction must know of a problem of discs; body inverse_mass.size() - 1 is the fixed one.
struct CoarseProblem {
  std::span<const std::int32_t> i, j;
  std::span<const double> n_x, n_z, inverse_mass;
  std::span<const double> mu;  ///< empty without friction
  const SweepPlan& plan;       ///< of the contacts as they stand
  int dim = 1;                 ///< unknowns per contact: 1 or 2
  bool spin = false;
};

/// Scales impulses; keeps workspace only.
class CoarseLoads {
 public:
  /// Takes what it keeps of the bodies from a memory: it ends with the frame of lay_out().
  void use(WorkMemory* memory) { rank_.use(memory), places_.use(memory), moves_.use(memory); }
  /// Lays the nodes of the field over the bodies of a problem.
  void lay_out(const CoarseProblem&, const BodyPlaces&, const TeamLoops&);
  /// Scales the impulses r of the problem that was laid out, which cause the velocities u = W r + q, each by
  /// a factor between 1/2 and 2. The result does not depend on the team of the loops.
  void scale(const CoarseProblem&, std::span<const double> u, std::vector<double>& r, const TeamLoops&);

 private:
  struct Body {
    NodePlace place;
    double inverse_mass = 0;
  };

  void add_contacts(const CoarseProblem&, std::span<const double> u, std::span<const double> r, int slice,
                    std::vector<double>& work);
  /// The sums of work_ and rows_.
  void add_up(const CoarseProblem&, std::span<const double> u, std::span<const double> r, const TeamLoops&);
  void add_bodies(const CoarseProblem&, int strip, std::vector<double>& rows) const;
  std::vector<double> solve() const;

  FieldGrid grid_;
  WorkArray<std::int32_t> rank_;  // of each body in the order of the strips, in which the next two stand
  WorkArray<Body> places_;
  WorkArray<NodeMoves> moves_;
  // Strips are shared in so many parts, whatever the number of threads: sums are those of parts, in order.
  static constexpr int parts = 16;
  std::array<std::vector<double>, parts> work_;  // sums of phi_k g_a
  std::array<std::vector<double>, parts> rows_;  // of A, as solve_field() takes them
};

}  // namespace drumlin::particles
