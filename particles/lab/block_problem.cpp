#include "particles/lab/block_problem.hpp"

#include <algorithm>

namespace drumlin::particles {
namespace {

/// Contacts of each body that moves, ascending. Walls and bodies of infinite mass couple nothing.
template <class Delassus>
std::vector<std::vector<int>> contacts_of_bodies(const Delassus& W) {
  std::vector<std::vector<int>> contacts(W.inverse_mass.size());
  for (int a = 0; a < W.contacts(); ++a)
    for (const auto body : {W.i[a], W.j[a]})
      if (W.inverse_mass[body] > 0) contacts[body].push_back(a);
  return contacts;
}

/// Contacts that share a body with contact a, itself included, ascending.
template <class Delassus>
std::vector<int> neighbours(const Delassus& W, const std::vector<std::vector<int>>& contacts, int a) {
  std::vector<int> found{a};
  for (const auto body : {W.i[a], W.j[a]})
    found.insert(found.end(), contacts[body].begin(), contacts[body].end());
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Velocities of the contacts in `rows` under a unit impulse of contact a, one column of each block. `state`
/// is at rest before and after: what was added is taken away again, exactly.
template <class Delassus>
void add_column(const Delassus& W, typename Delassus::State& state, std::span<const int> rows, int a,
                int component, std::vector<Eigen::Matrix2d>& blocks) {
  typename Delassus::Impulse unit{};
  unit[component] = 1;
  W.push(state, a, unit);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto u = W.relative_velocity(state, rows[k]);
    for (int e = 0; e < Delassus::dim; ++e) blocks[k](e, component) = u[e];
  }
  unit[component] = -1;
  W.push(state, a, unit);
}

/// W by columns of blocks; it is symmetric, so that column a transposed is row a.
template <class Delassus>
BlockDelassus assembled(const Delassus& W) {
  const auto contacts = contacts_of_bodies(W);
  typename Delassus::State state;
  W.rest(state);
  BlockDelassus blocks;
  blocks.row_start = {0};
  for (int a = 0; a < W.contacts(); ++a) {
    const auto near = neighbours(W, contacts, a);
    std::vector<Eigen::Matrix2d> column(near.size(), Eigen::Matrix2d::Zero());
    for (int component = 0; component < Delassus::dim; ++component)
      add_column(W, state, near, a, component, column);
    for (std::size_t k = 0; k < near.size(); ++k) {
      Eigen::Matrix2d block = column[k].transpose();
      if (near[k] == a) {
        if constexpr (Delassus::dim == 1) block(1, 1) = block(0, 0);
        blocks.diagonal.push_back(block);
      }
      blocks.column.push_back(near[k]);
      blocks.block.push_back(block);
    }
    blocks.row_start.push_back(static_cast<int>(blocks.column.size()));
  }
  return blocks;
}

template <class Problem>
BlockProblem with_friction(const Problem& problem) {
  BlockProblem blocks;
  blocks.W = assembled(problem.W);
  blocks.q = problem.q;
  blocks.mu = problem.mu;
  blocks.time_step = problem.time_step, blocks.rounding = problem.rounding;
  return blocks;
}

}  // namespace

BlockProblem block_problem(const CoulombProblem& problem) { return with_friction(problem); }
BlockProblem block_problem(const CoulombSpinProblem& problem) { return with_friction(problem); }

BlockProblem block_problem(const FrictionlessProblem& problem) {
  BlockProblem blocks;
  blocks.W = assembled(problem.W);
  blocks.q = block_layout<FrictionlessProblem>(problem.q);
  blocks.mu.assign(problem.contacts(), 0.0);
  blocks.time_step = problem.time_step, blocks.rounding = problem.rounding;
  return blocks;
}

std::optional<BlockProblem> block_problem(const DiscProblem& problem) {
  return std::visit(
      [](const auto* of_kind) -> std::optional<BlockProblem> {
        if constexpr (requires { block_problem(*of_kind).W; })
          if (!of_kind->W.coupled()) return block_problem(*of_kind);
        return std::nullopt;
      },
      problem);
}

}  // namespace drumlin::particles
