#include "particles/distributed/tile_coarse_loads.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "particles/solver/coarse_moves.hpp"

namespace drumlin::particles {
namespace {

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

}  // namespace

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
  grid_ = field_grid({-extremes[1], extremes[0], -extremes[3], extremes[2]}, contacts_of_all, extremes[4]);
  terms_ = contacts_of_all;
  places_.resize(contacts.x.size());
  moves_.resize(contacts.x.size());
  for (std::size_t b = 0; b < places_.size(); ++b) places_[b] = grid_.place_at(contacts.x[b], contacts.z[b]);
}

template <class Problem>
template <class T>
void TileCoarseLoads<Problem>::move_bodies(const TiledContacts& contacts, Halo& halo,
                                           TileBlocks<T, dim, spin>& blocks) {
  std::fill(moves_.begin(), moves_.end(), NodeMoves{});
  const auto work = [&](std::size_t t) {
    for (const auto& block : blocks.of_tile(t))
      for (int k = 0; k < block.width; ++k)
        if (block.r[0][k] > 0)
          CoarseContact<T, dim, spin>(block, k).move(places_.data(), blocks.bodies().data(), moves_.data());
  };
  const auto exchange = [&](int colour) {
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
  };
  each_colour(
      contacts.tiles, loops_, work, [](int) {}, exchange);
}

template <class Problem>
template <class T>
std::array<double, 2> TileCoarseLoads<Problem>::find_bounds(const TiledContacts& contacts,
                                                            TileBlocks<T, dim, spin>& blocks) {
  std::array<double, 2> bounds{0, 0};
  power_.clear();
  for (const auto& block : blocks.all())
    for (int k = 0; k < block.width; ++k) {
      const bool carries = block.r[0][k] > 0;
      power_.push_back(carries ? CoarseContact<T, dim, spin>(block, k).power(block, k, blocks.bodies().data())
                               : 0);
      bounds[0] = std::max(bounds[0], std::abs(power_.back()));
    }
  for (std::size_t b = 0; b < moves_.size(); ++b) {
    if (!contacts.counts_here[b]) continue;
    const double mass = 1.0 / blocks.bodies()[b].inverse_mass;
    for (const NodeMove& move : moves_[b])
      bounds[1] = std::max(bounds[1], mass * product(weighted(move), move));
  }
  ranks_.largest(bounds);
  return bounds;
}

template <class Problem>
template <class T>
std::vector<double> TileCoarseLoads<Problem>::add_up(const TiledContacts& contacts,
                                                     TileBlocks<T, dim, spin>& blocks) {
  const std::array<double, 2> bounds = find_bounds(contacts, blocks);
  if (!(bounds[0] > 0 && bounds[1] > 0 && bounds[0] < 1e100 && bounds[1] < 1e100)) return {};
  const FixedPoint powers(bounds[0], terms_), energies(bounds[1], 4 * terms_);
  constexpr int numbers = entries_of_node + 1;
  const std::size_t length = static_cast<std::size_t>(numbers) * grid_.nodes();
  std::array<std::vector<std::int64_t>, parts> sums;
  const auto share = [](std::size_t count, int part) { return count * part / parts; };
  const auto add_block = [&](std::size_t b, std::vector<std::int64_t>& sum) {
    const auto& block = blocks.all()[b];
    for (int k = 0; k < block.width; ++k) {
      const double power = power_[block.width * b + k];
      if (power == 0) continue;
      const NodePlace& at = places_[CoarseContact<T, dim, spin>(block, k).i];
      const auto weights = at.weights();
      for (const int corner : {0, 1, 2, 3})
        sum[numbers * grid_.corner(at, corner) + entries_of_node] += powers.rounded(weights[corner] * power);
    }
  };
  const auto add_body = [&](std::size_t b, std::vector<std::int64_t>& sum) {
    each_product(
        grid_, places_[b], moves_[b], 1.0 / blocks.bodies()[b].inverse_mass,
        [&](int node, int entry, double energy) { sum[numbers * node + entry] += energies.rounded(energy); });
  };
  loops_.each_of(parts, [&](int part) {
    auto& sum = sums[part];
    sum.assign(length, 0);
    const std::size_t all = blocks.all().size();
    for (std::size_t b = share(all, part); b < share(all, part + 1); ++b) add_block(b, sum);
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
template <class T>
bool TileCoarseLoads<Problem>::scale(const TiledContacts& contacts, Halo& halo,
                                     TileBlocks<T, dim, spin>& blocks) {
  move_bodies(contacts, halo, blocks);
  const std::vector<double> sums = add_up(contacts, blocks);
  if (sums.empty()) return false;
  std::vector<double> rows, right;
  constexpr int numbers = entries_of_node + 1;
  for (int k = 0; k < grid_.nodes(); ++k) {
    rows.insert(rows.end(), sums.begin() + numbers * k, sums.begin() + numbers * k + entries_of_node);
    right.push_back(-sums[numbers * k + entries_of_node]);
  }
  const std::vector<double> field = solve_field(grid_, rows, right);
  if (field.empty()) return false;
  loops_.each(blocks.all().size(), [&](std::size_t begin, std::size_t end) {
    scale_blocks(blocks.all().subspan(begin, end - begin), grid_, places_.data(), field);
  });
  return true;
}

#define DRUMLIN_INSTANTIATE(Problem)                                                                 \
  template class TileCoarseLoads<Problem>;                                                           \
  template bool TileCoarseLoads<Problem>::scale(                                                     \
      const TiledContacts&, Halo&, TileBlocks<float, TileCoarseLoads::dim, TileCoarseLoads::spin>&); \
  template bool TileCoarseLoads<Problem>::scale(                                                     \
      const TiledContacts&, Halo&, TileBlocks<double, TileCoarseLoads::dim, TileCoarseLoads::spin>&);
DRUMLIN_INSTANTIATE(FrictionlessProblem)
DRUMLIN_INSTANTIATE(CoulombProblem)
DRUMLIN_INSTANTIATE(CoulombSpinProblem)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
