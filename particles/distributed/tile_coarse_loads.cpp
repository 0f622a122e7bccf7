#include "particles/distributed/tile_coarse_loads.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

namespace drumlin::particles {
namespace {

// As in particles/solver/coarse_loads.cpp, where they are explained.
constexpr double contacts_per_cell = 1400, damping = 1e-3, ground = 1e-10, sliding = 1e-6;
constexpr double edges_per_contact = 2.001;
// Sums that threads share are cut into so many.
constexpr int parts = 16;

/// Adds numbers up to a known bound as integers, whose order does not matter.
class FixedPoint {
 public:
  FixedPoint(double bound, std::int64_t terms)
      : unit_(std::ldexp(
            1, std::ilogb(bound) + 1 + std::max(12, std::ilogb(static_cast<double>(terms)) + 1) - 62)),
        units_(1 / unit_) {}
  /// Rounded to the next integer: beside this one, which has no digits after the point, there are none
  /// either.
  std::int64_t rounded(double term) const {
    constexpr double integers = 0x1.8p52;  // and all within 2^51 of it
    return std::bit_cast<std::int64_t>(term * units_ + integers) - std::bit_cast<std::int64_t>(integers);
  }
  double value(std::int64_t sum) const { return static_cast<double>(sum) * unit_; }

 private:
  double unit_, units_;  // powers of two
};

/// The four entries of a move as one vector.
template <class Move>
auto vector_of(Move& move) {
  using Entries = std::conditional_t<std::is_const_v<Move>, const Eigen::Array4f, Eigen::Array4f>;
  return Eigen::Map<Entries, Eigen::Aligned16>(move.entries.data());
}

/// m v . v' + J omega omega', with J = m r^2 / 2 and s = r omega.
template <class Move>
double energy(const Move& v, const Move& w, double mass) {
  return mass * static_cast<double>((vector_of(v) * Eigen::Array4f(1, 1, 0.5F, 0) * vector_of(w)).sum());
}

}  // namespace

std::vector<double> solve_field(const FieldGrid& grid, std::span<const double> rows,
                                std::span<const double> right) {
  const int nodes = grid.nodes();
  double largest = 0;
  for (int k = 0; k < nodes; ++k) largest = std::max(largest, rows[entries_of_node * k]);
  if (!(largest > 0)) return {};
  std::vector<Eigen::Triplet<double>> entries;  // of the lower triangle
  for (int k = 0; k < nodes; ++k)
    for (int e = 0; e < entries_of_node; ++e) {
      const int column = k % grid.columns + (e + 2) % 5 - 2, row = k / grid.columns + (e + 2) / 5;
      if (column < 0 || column >= grid.columns || row >= grid.rows) continue;
      double value = rows[entries_of_node * k + e];
      if (e == 0) value += damping * value + ground * largest;
      if (value != 0) entries.emplace_back(grid.index(column, row), k, value);
    }
  Eigen::SparseMatrix<double> matrix(nodes, nodes);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
  if (factors.info() != Eigen::Success) return {};
  const Eigen::VectorXd field = factors.solve(Eigen::Map<const Eigen::VectorXd>(right.data(), nodes));
  if (!field.allFinite()) return {};
  return {field.begin(), field.end()};
}

template <class Problem>
auto TileCoarseLoads<Problem>::place_at(double x, double z) const -> Place {
  const double from_left = (x - grid_.x) / grid_.edge, from_below = (z - grid_.z) / grid_.edge;
  const auto node = [](double from, int last) {
    return static_cast<std::int16_t>(std::clamp(static_cast<int>(from), 0, last));
  };
  Place place{node(from_left, grid_.columns - 2), node(from_below, grid_.rows - 2),
              node(from_left + 0.5, grid_.columns - 1), node(from_below + 0.5, grid_.rows - 1)};
  place.right = from_left - place.column, place.up = from_below - place.row;
  return place;
}

template <class Problem>
void TileCoarseLoads<Problem>::lay_out(const Problem& problem, const TiledContacts& contacts,
                                       std::int64_t contacts_of_all) {
  const auto& W = problem.W;
  constexpr double none = -1e300;
  std::array<double, 5> extremes{none, none, none, none, 0};  // of x, -x, z, -z; longest contact
  for (std::size_t b = 0; b < contacts.x.size(); ++b) {
    extremes[0] = std::max(extremes[0], contacts.x[b]), extremes[1] = std::max(extremes[1], -contacts.x[b]);
    extremes[2] = std::max(extremes[2], contacts.z[b]), extremes[3] = std::max(extremes[3], -contacts.z[b]);
  }
  for (int a = 0; a < problem.contacts(); ++a)
    if (W.j[a] != W.fixed())
      extremes[4] = std::max({extremes[4], std::abs(contacts.x[W.i[a]] - contacts.x[W.j[a]]),
                              std::abs(contacts.z[W.i[a]] - contacts.z[W.j[a]])});
  ranks_.largest(extremes);
  const double width = extremes[0] + extremes[1], height = extremes[2] + extremes[3];
  const double cells =
      std::max(1.0, std::round(std::sqrt(static_cast<double>(contacts_of_all) / contacts_per_cell)));
  grid_ = {-extremes[1], -extremes[3], std::max(width, height) / cells};
  // The nodes around one body of a contact are then among the nine of the other.
  grid_.edge = std::max(grid_.edge, edges_per_contact * extremes[4]);
  if (!(grid_.edge > 0)) grid_.edge = 1;
  grid_.columns = std::max(1, static_cast<int>(std::ceil(width / grid_.edge))) + 1;
  grid_.rows = std::max(1, static_cast<int>(std::ceil(height / grid_.edge))) + 1;
  terms_ = contacts_of_all;
  places_.resize(contacts.x.size());
  moves_.resize(contacts.x.size());
  for (std::size_t b = 0; b < places_.size(); ++b) places_[b] = place_at(contacts.x[b], contacts.z[b]);
}

template <class Problem>
double TileCoarseLoads<Problem>::power(const Problem& problem, std::int32_t a, std::span<const double> u,
                                       std::span<const double> r) {
  const double r_n = r[dim * a];
  double g = r_n * u[dim * a];
  if constexpr (dim == 2) {
    const double r_t = r[2 * a + 1], u_t = u[2 * a + 1], bound = r_n * problem.mu[a];
    g += r_t * u_t + (std::abs(r_t) >= bound * (1 - sliding) ? bound * std::abs(u_t) : 0);
  }
  return g;
}

template <class Problem>
void TileCoarseLoads<Problem>::push(const Problem& problem, std::int32_t a, std::span<const double> r) {
  const auto& W = problem.W;
  const double r_n = r[dim * a];
  if (!(r_n > 0)) return;
  double r_t = 0;
  if constexpr (dim == 2) r_t = r[2 * a + 1];
  const Place& at = places_[W.i[a]];
  const auto weights = at.weights();
  const auto p_x = static_cast<float>(W.n_x[a] * r_n + W.n_z[a] * r_t),
             p_z = static_cast<float>(W.n_z[a] * r_n - W.n_x[a] * r_t), p_t = static_cast<float>(r_t);
  const Eigen::Array4f shares = Eigen::Array4d::Map(weights.data()).template cast<float>();
  const auto move = [&](std::int32_t b, float sign) {
    const Place& own = places_[b];
    const auto mass = static_cast<float>(W.inverse_mass[b]);
    const Eigen::Array4f change{sign * mass * p_x, sign * mass * p_z, spin ? -2 * mass * p_t : 0, 0};
    // Of the lower left node around the contact.
    Move* const first = &moves_[b][3 * (at.row - own.next_row + 1) + at.column - own.next_column + 1];
    vector_of(first[0]) += shares[0] * change, vector_of(first[1]) += shares[1] * change;
    vector_of(first[3]) += shares[2] * change, vector_of(first[4]) += shares[3] * change;
  };
  move(W.i[a], 1);
  if (W.j[a] != W.fixed()) move(W.j[a], -1);
}

template <class Problem>
void TileCoarseLoads<Problem>::move_bodies(const Problem& problem, const TiledContacts& contacts, Halo& halo,
                                           std::span<const double> r) {
  std::fill(moves_.begin(), moves_.end(), Moves{});
  each_colour(
      contacts.tiles, loops_,
      [&](std::size_t t) {
        for (std::int32_t a = contacts.tiles[t].begin; a < contacts.tiles[t].end; ++a) push(problem, a, r);
      },
      [](int) {},
      [&](int colour) {
        for (int k = 0; k < 9; ++k) {
          halo.start(colour, [&](std::int32_t b) {
            const auto& move = moves_[b][k].entries;
            return std::array<double, Halo::numbers>{move[0], move[1], move[2]};
          });
          halo.finish(colour, [&](std::int32_t b, const auto& numbers) {
            for (std::size_t c = 0; c < numbers.size(); ++c)
              moves_[b][k].entries[c] = static_cast<float>(numbers[c]);
          });
        }
      });
}

template <class Problem>
std::array<double, 2> TileCoarseLoads<Problem>::find_bounds(const Problem& problem,
                                                            const TiledContacts& contacts,
                                                            std::span<const double> u,
                                                            std::span<const double> r) {
  std::array<double, 2> bounds{0, 0};
  power_.assign(problem.contacts(), 0.0);
  for (int a = 0; a < problem.contacts(); ++a) {
    if (!(r[dim * a] > 0)) continue;
    power_[a] = power(problem, a, u, r);
    bounds[0] = std::max(bounds[0], std::abs(power_[a]));
  }
  for (std::size_t b = 0; b < moves_.size(); ++b) {
    if (!contacts.counts_here[b]) continue;
    const double mass = 1 / problem.W.inverse_mass[b];
    for (const Move& move : moves_[b]) bounds[1] = std::max(bounds[1], energy(move, move, mass));
  }
  ranks_.largest(bounds);
  return bounds;
}

template <class Problem>
std::vector<double> TileCoarseLoads<Problem>::add_up(const Problem& problem, const TiledContacts& contacts,
                                                     std::span<const double> u, std::span<const double> r) {
  const auto& W = problem.W;
  const std::array<double, 2> bounds = find_bounds(problem, contacts, u, r);
  if (!(bounds[0] > 0 && bounds[1] > 0 && bounds[0] < 1e100 && bounds[1] < 1e100)) return {};
  const FixedPoint powers(bounds[0], terms_), energies(bounds[1], 4 * terms_);
  constexpr int numbers = entries_of_node + 1;
  const std::size_t length = static_cast<std::size_t>(numbers) * grid_.nodes();
  std::array<std::vector<std::int64_t>, parts> sums;
  const auto share = [](std::size_t count, int part) { return count * part / parts; };
  const auto add_contact = [&](std::size_t a, std::vector<std::int64_t>& sum) {
    if (power_[a] == 0) return;
    const Place& at = places_[W.i[a]];
    const auto weights = at.weights();
    for (const int k : {0, 1, 2, 3})
      sum[numbers * grid_.index(at.column + k % 2, at.row + k / 2) + entries_of_node] +=
          powers.rounded(weights[k] * power_[a]);
  };
  const auto add_body = [&](std::size_t b, std::vector<std::int64_t>& sum) {
    const Place& at = places_[b];
    const Moves& moves = moves_[b];
    const double mass = 1 / W.inverse_mass[b];
    std::array<int, 9> moved{};
    int count = 0;
    for (int k = 0; k < 9; ++k)
      if ((vector_of(moves[k]) != 0).any()) moved[count++] = k;
    for (int m = 0; m < count; ++m) {
      const int k = moved[m];
      const std::size_t row = numbers * grid_.index(at.next_column + k % 3 - 1, at.next_row + k / 3 - 1);
      for (int n = m; n < count; ++n) {
        const int l = moved[n];
        sum[row + 5 * (l / 3 - k / 3) + l % 3 - k % 3] += energies.rounded(energy(moves[k], moves[l], mass));
      }
    }
  };
  loops_.each_of(parts, [&](int part) {
    auto& sum = sums[part];
    sum.assign(length, 0);
    const std::size_t all = problem.contacts();
    for (std::size_t a = share(all, part); a < share(all, part + 1); ++a) add_contact(a, sum);
    for (std::size_t b = share(moves_.size(), part); b < share(moves_.size(), part + 1); ++b)
      if (contacts.counts_here[b]) add_body(b, sum);
  });
  for (int part = 1; part < parts; ++part)
    for (std::size_t k = 0; k < length; ++k) sums[0][k] += sums[part][k];
  ranks_.add(sums[0]);
  std::vector<double> values(length);
  for (std::size_t k = 0; k < length; ++k)
    values[k] = k % numbers == entries_of_node ? powers.value(sums[0][k]) : energies.value(sums[0][k]);
  return values;
}

template <class Problem>
void TileCoarseLoads<Problem>::scale(const Problem& problem, const TiledContacts& contacts, Halo& halo,
                                     std::span<const double> u, std::vector<double>& r) {
  move_bodies(problem, contacts, halo, r);
  const std::vector<double> sums = add_up(problem, contacts, u, r);
  if (sums.empty()) return;
  std::vector<double> rows, right;
  constexpr int numbers = entries_of_node + 1;
  for (int k = 0; k < grid_.nodes(); ++k) {
    rows.insert(rows.end(), sums.begin() + numbers * k, sums.begin() + numbers * k + entries_of_node);
    right.push_back(-sums[numbers * k + entries_of_node]);
  }
  const std::vector<double> field = solve_field(grid_, rows, right);
  if (field.empty()) return;
  loops_.each(problem.contacts(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      const Place& at = places_[problem.W.i[a]];
      const auto weights = at.weights();
      double factor = 1;
      for (const int k : {0, 1, 2, 3})
        factor += weights[k] * field[grid_.index(at.column + k % 2, at.row + k / 2)];
      factor = std::clamp(factor, 0.5, 2.0);
      for (int c = 0; c < dim; ++c) r[dim * a + c] *= factor;
    }
  });
}

template class TileCoarseLoads<FrictionlessProblem>;
template class TileCoarseLoads<CoulombProblem>;
template class TileCoarseLoads<CoulombSpinProblem>;

}  // namespace drumlin::particles
