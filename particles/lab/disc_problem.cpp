#include "particles/lab/disc_problem.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <numeric>

#include "particles/lab/block_problem.hpp"

namespace drumlin::particles {
namespace {

constexpr double accuracy = 1e-9;  // of entries of W, relative to the diagonal

/// What a block off the diagonal says if both contacts are on one disc.
struct Coupling {
  double inverse_mass = 0;
  std::complex<double> turn;  ///< from the place of the row's contact on the rim to that of the column's
};

std::optional<Coupling> coupling(const Eigen::Matrix2d& block) {
  const double w = (block(1, 1) - block(0, 0)) / 2;
  const std::complex<double> turn(block(0, 0) / w, block(0, 1) / w);
  const bool fits = w > 0 && std::abs(std::abs(turn) - 1) <= accuracy &&
                    std::abs(block(0, 1) + block(1, 0)) <= accuracy * w;
  if (!fits) return {};
  return Coupling{w, turn / std::abs(turn)};
}

/// A row of W: the contacts that share a disc with one contact, each on its first or second side.
struct Neighbour {
  int contact = 0;
  Coupling coupling;
  int side = -1;
};
using Neighbours = std::vector<std::vector<Neighbour>>;

const Neighbour* find(const std::vector<Neighbour>& row, int contact) {
  const auto found =
      std::lower_bound(row.begin(), row.end(), contact,
                       [](const Neighbour& neighbour, int wanted) { return neighbour.contact < wanted; });
  return found != row.end() && found->contact == contact ? &*found : nullptr;
}

std::optional<Neighbours> neighbours_of(const BlockDelassus& W) {
  Neighbours rows(W.contacts());
  for (int a = 0; a < W.contacts(); ++a) {
    const auto& own = W.diagonal[a];
    if (std::abs(own(1, 1) - 3 * own(0, 0)) > accuracy * own(1, 1) ||
        std::abs(own(0, 1)) > accuracy * own(0, 0))
      return {};
    for (int k = W.row_start[a]; k < W.row_start[a + 1]; ++k) {
      if (W.column[k] == a || W.block[k].isZero(0)) continue;
      const auto coupled = coupling(W.block[k]);
      if (!coupled) return {};
      rows[a].push_back({W.column[k], *coupled});
    }
  }
  return rows;
}

bool on_one_disc(const Neighbours& rows, const Neighbour& b, const Neighbour& c) {
  const Neighbour* between = find(rows[b.contact], c.contact);
  if (between == nullptr) return false;
  const auto mismatch = b.coupling.turn * between->coupling.turn - c.coupling.turn;
  return std::abs(mismatch) < 1;  // 0, or 2 where the angles miss by half a turn
}

/// Sorts the neighbours of each contact by the disc that they share with it.
void set_sides(Neighbours& rows) {
  for (auto& row : rows) {
    if (row.empty()) continue;
    row[0].side = 0;
    for (auto& other : row)
      if (other.side < 0) other.side = on_one_disc(rows, row[0], other) ? 0 : 1;
  }
}

/// Smallest of the sides (2 contact + side) joined so far with this one.
int first_of(std::vector<int>& joined, int side) {
  while (joined[side] != side) side = joined[side] = joined[joined[side]];
  return side;
}

/// Sides of contacts that are on the same disc get the same number.
std::vector<int> discs_of_sides(const Neighbours& rows) {
  std::vector<int> joined(2 * rows.size());
  std::iota(joined.begin(), joined.end(), 0);
  for (std::size_t a = 0; a < rows.size(); ++a)
    for (const Neighbour& b : rows[a]) {
      const Neighbour* back = find(rows[b.contact], static_cast<int>(a));
      if (back == nullptr) continue;  // the comparison of W at the end refuses it
      const int one = first_of(joined, 2 * static_cast<int>(a) + b.side);
      const int other = first_of(joined, 2 * b.contact + back->side);
      joined[std::max(one, other)] = std::min(one, other);
    }
  std::vector<int> disc(joined.size());
  for (std::size_t side = 0; side < joined.size(); ++side)
    disc[side] = first_of(joined, static_cast<int>(side));
  return disc;
}

/// Directions from j to i, i the body of side 0; the first contact of each connected set defines an axis.
std::vector<std::complex<double>> normals(const Neighbours& rows) {
  std::vector<std::complex<double>> normal(rows.size());
  std::vector<int> waiting;
  for (std::size_t first = 0; first < rows.size(); ++first) {
    if (normal[first] != 0.0) continue;
    normal[first] = 1;
    for (waiting = {static_cast<int>(first)}; !waiting.empty();) {
      const int a = waiting.back();
      waiting.pop_back();
      for (const Neighbour& b : rows[a]) {
        const Neighbour* back = find(rows[b.contact], a);
        if (normal[b.contact] != 0.0 || back == nullptr) continue;
        const double sign = b.side == back->side ? 1 : -1;
        const auto turned = sign * normal[a] * b.coupling.turn;
        normal[b.contact] = turned / std::abs(turned);
        waiting.push_back(b.contact);
      }
    }
  }
  return normal;
}

/// 1 / mass of the disc on each side of a contact. A side without neighbours takes what is left of W_nn; with
/// none on either, one disc against the fixed body.
std::array<double, 2> inverse_masses(const std::vector<Neighbour>& row, double W_nn) {
  std::array<double, 2> inverse{0, 0};
  for (const Neighbour& b : row)
    if (inverse[b.side] == 0) inverse[b.side] = b.coupling.inverse_mass;
  for (int side = 0; side < 2; ++side)
    if (inverse[side] == 0) {
      const double left = W_nn - inverse[1 - side];
      return side == 0 ? std::array<double, 2>{W_nn, 0}
                       : std::array<double, 2>{inverse[0], left > 1e-6 * W_nn ? left : 0};
    }
  return inverse;
}

bool same_matrix(const BlockDelassus& A, const BlockDelassus& B) {
  for (int a = 0; a < A.contacts(); ++a) {
    std::vector<Eigen::Matrix2d> row(B.contacts() == 0 ? 0 : B.row_start[a + 1] - B.row_start[a]);
    for (int k = A.row_start[a], l = B.row_start[a]; k < A.row_start[a + 1] || l < B.row_start[a + 1];) {
      const int none = A.contacts(), of_A = k < A.row_start[a + 1] ? A.column[k] : none,
                of_B = l < B.row_start[a + 1] ? B.column[l] : none;
      Eigen::Matrix2d difference = Eigen::Matrix2d::Zero();
      if (of_A <= of_B) difference += A.block[k++];
      if (of_B <= of_A) difference -= B.block[l++];
      if (!(difference.cwiseAbs().maxCoeff() <= accuracy * A.diagonal[a](1, 1))) return false;
    }
  }
  return true;
}

}  // namespace

std::optional<CoulombSpinProblem> disc_problem(const BlockProblem& blocks) {
  auto rows = neighbours_of(blocks.W);
  if (!rows) return {};
  set_sides(*rows);
  const std::vector<int> disc = discs_of_sides(*rows);
  const auto normal = normals(*rows);
  CoulombSpinProblem problem;
  problem.q = blocks.q;
  problem.mu = blocks.mu;
  problem.time_step = blocks.time_step, problem.rounding = blocks.rounding;
  std::vector<int> body(disc.size(), -1);
  std::vector<std::array<int, 2>> ends(rows->size());
  for (int a = 0; a < blocks.contacts(); ++a) {
    const auto inverse = inverse_masses((*rows)[a], blocks.W.diagonal[a](0, 0));
    for (int side = 0; side < 2; ++side) {
      int& number = body[disc[2 * a + side]];
      if (number < 0 && inverse[side] > 0) {
        number = static_cast<int>(problem.W.inverse_mass.size());
        problem.W.inverse_mass.push_back(inverse[side]);
      }
      ends[a][side] = inverse[side] > 0 ? number : -1;
    }
  }
  const int fixed = static_cast<int>(problem.W.inverse_mass.size());
  problem.W.inverse_mass.push_back(0);
  for (int a = 0; a < blocks.contacts(); ++a)
    problem.W.add(ends[a][0] < 0 ? fixed : ends[a][0], ends[a][1] < 0 ? fixed : ends[a][1], normal[a].real(),
                  normal[a].imag());
  if (!same_matrix(blocks.W, block_problem(problem).W)) return {};
  return problem;
}

}  // namespace drumlin::particles
