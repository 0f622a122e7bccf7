#pragma once
// W as sparse rows of small blocks: the form in which contact problems travel in files.
#include <Eigen/Dense>
#include <cmath>
#include <span>
#include <vector>

#include "particles/contact_law/coulomb_coupled.hpp"

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
  double sweep(std::span<const double> q, std::span<const double> mu, std::span<double> r, State& state,
               std::span<double> step) const;
  static std::span<double> numbers(State& state) { return state; }

 private:
  Eigen::Vector2d row_times(int a, std::span<const double> r) const;
};

}  // namespace drumlin::particles
