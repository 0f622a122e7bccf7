#pragma once
// Coarse correction of the impulses of a large packing: a smooth field scales them, so that what they carry
// balances over long distances, which sweeps settle last.
//
// r_a becomes (1 + s(x_a)) r_a with s = sum_k s_k phi_k, phi_k bilinear on square cells: every impulse stays
// in its cone. At a solution no contact does work, but for the friction of those that slide,
//   g_a = r_n u_n + r_t u_t (+ mu r_n |u_t| where |r_t| = mu r_n) = 0;
// the field makes its weighted sums vanish, |u_t| as it stands (a Galerkin step):
//   sum_l A_kl s_l = - sum_a phi_k(x_a) g_a,  A_kl = (phi_k r) . W (phi_l r),
// in A with hats that are linear between the bodies of a contact (particles/solver/coarse_kernels.hpp).
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/parallel/parallel_loops.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/solver/coarse_field.hpp"
#include "particles/solver/coarse_kernels.hpp"

namespace drumlin::particles {

/// Where the bodies of a contact problem are, in any unit; empty where nobody knows.
struct BodyPlaces {
  std::span<const double> x, z;
};

/// Problems of fewer contacts are left to the sweeps.
inline constexpr int least_contacts_of_coarse_loads = 50000;
/// Sweeps between two corrections.
inline constexpr int sweeps_between_coarse_loads = 40;

template <class T, class Law, bool spin>
class StripProblem;

/// Scales impulses; keeps workspace only.
class CoarseLoads {
 public:
  /// Takes what it keeps of the bodies from a memory: it ends with the scope of lay_out().
  void use(WorkMemory* memory) { records_.use(memory); }
  /// Lays the nodes of the field over the bodies of the contacts (i, j), which have been packed in strips;
  /// body positions.x.size() is the fixed one.
  template <class T, class Law, bool spin>
  void lay_out(std::span<const std::int32_t> i, std::span<const std::int32_t> j, const BodyPlaces& places,
               const StripProblem<T, Law, spin>&, const ParallelLoops&);
  /// Scales the impulses of the strips that were laid out each by a factor between 1/2 and 2,
  /// as impulses and bodies stand. False, and nothing scaled, where there is no good field. The result does
  /// not depend on the pool of the loops.
  template <class T, class Law, bool spin>
  bool scale(StripProblem<T, Law, spin>&, const ParallelLoops&);

 private:
  template <class T, class Law, bool spin>
  void add_contacts(StripProblem<T, Law, spin>&, int strip, int phase);
  template <class T, class Law, bool spin>
  void add_bodies(const StripProblem<T, Law, spin>&, int strip, int part);
  template <class T, class Law, bool spin>
  void exchange(StripProblem<T, Law, spin>&, int phase);
  /// The sums of work_ and rows_.
  template <class T, class Law, bool spin>
  void add_up(StripProblem<T, Law, spin>&, const ParallelLoops&);
  std::vector<double> solve() const;

  FieldGrid grid_;
  CoarseRecords<WorkArray> records_;
  std::size_t rows() const { return static_cast<std::size_t>(entries_of_node) * grid_.nodes(); }
  // Of each part of the strips, whatever the number of threads and ranks: sums are those of parts, in order.
  std::vector<double> work_;  // sums of phi_k g_a
  std::vector<double> rows_;  // of A, as solve_field() takes them
};

}  // namespace drumlin::particles
