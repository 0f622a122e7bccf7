#pragma once
// W as sparse rows of small blocks: the form in which contact problems travel in files.
#include <Eigen/Dense>
#include <cmath>
#include <span>
#include <vector>

#include "particles/contact/contact_problem.hpp"
#include "particles/contact_law/local_block.hpp"

namespace drumlin::particles {

/// Rows of blocks (compressed); `diagonal[a]` repeats W_aa, which the sweeps need at once.
class BlockDelassus {
 public:
  static constexpr int dim = 2;
  using State = std::vector<double>;  ///< a copy of r: the rows are multiplied afresh

  std::vector<int> row_start;  ///< contacts + 1 entries
  std::vector<int> column;
  std::vector<Eigen::Matrix2d> block;
  std::vector<Eigen::Matrix2d> diagonal;

  int contacts() const { return static_cast<int>(diagonal.size()); }
  void load(State& state, std::span<const double> r) const { state.assign(r.begin(), r.end()); }
  double largest_eigenvalue(int a) const;
  void velocities(std::span<const double> r, std::span<const double> q, State& scratch,
                  std::vector<double>& u) const;
  /// The part of W r in u of contact a.
  ContactNumbers<2> relative_velocity(const State& state, int a) const;
  /// Contact a solved with the others as they stand: u are the velocities that belong to its impulses r.
  ContactNumbers<2> solved(Coulomb, int a, const contact_law::Coefficients<double, Coulomb>& mu,
                           const ContactNumbers<2>& u, const ContactNumbers<2>& r) const;
  void push(State& state, int a, const ContactNumbers<2>& dr) const {
    for (int e = 0; e < 2; ++e) state[2 * a + e] += dr[e];
  }
  static std::span<double> numbers(State& state) { return state; }
};

using BlockProblem = ContactProblem<BlockDelassus, Coulomb>;  ///< from a file

}  // namespace drumlin::particles
