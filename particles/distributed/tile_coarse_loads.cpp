#include "particles/distributed/tile_coarse_loads.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "particles/solver/coarse_kernels.hpp"

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
  /// The same of several, of which a compiler makes vectors.
  template <class T, std::size_t rows, std::size_t width>
  auto rounded(const std::array<std::array<T, width>, rows>& terms) const {
    std::array<std::array<std::int64_t, width>, rows> whole;
    for (std::size_t p = 0; p < rows; ++p)
      for (std::size_t b = 0; b < width; ++b) whole[p][b] = rounded(static_cast<double>(terms[p][b]));
    return whole;
  }
  double value(std::int64_t sum) const { return static_cast<double>(sum) * unit_; }

 private:
  double unit_, units_;  // powers of two
};

/// Calls work(first, count) for the bodies begin to end - 1 in a row that are all counted on this rank.
template <class Work>
void each_run(const TiledContacts& contacts, std::size_t begin, std::size_t end, Work work) {
  for (std::size_t last = begin; begin < end; begin = last) {
    last = begin + 1;
    while (last < end && !contacts.counts_here[last] == !contacts.counts_here[begin]) ++last;
    if (contacts.counts_here[begin]) work(begin, last - begin);
  }
}

}  // namespace

template <class Problem>
template <class T>
void TileCoarseLoads<Problem>::lay_out(const Problem& problem, const TiledContacts& contacts,
                                       std::int64_t contacts_of_all, const TileBlocks<T, dim, spin>& blocks) {
  const auto& W = problem.W;
  constexpr double none = -1e300;
  std::array<double, 5> extremes{none, none, none, none, 0};  // of x, -x, z, -z; longest contact
  for (std::size_t b = 0; b < contacts.x.size(); ++b) {
    extremes[0] = std::max(extremes[0], contacts.x[b]), extremes[1] = std::max(extremes[1], -contacts.x[b]);
    extremes[2] = std::max(extremes[2], contacts.z[b]), extremes[3] = std::max(extremes[3], -contacts.z[b]);
  }
  double along_x = 0, along_z = 0;
  for (int a = 0; a < problem.contacts(); ++a) {
    const std::int32_t i = W.i[a], j = W.j[a] == W.fixed() ? i : W.j[a];
    along_x = std::max(along_x, std::abs(contacts.x[i] - contacts.x[j]));
    along_z = std::max(along_z, std::abs(contacts.z[i] - contacts.z[j]));
  }
  extremes[4] = std::max(along_x, along_z);
  ranks_.largest(extremes);
  grid_ = field_grid({-extremes[1], extremes[0], -extremes[3], extremes[2]}, contacts_of_all, extremes[4]);
  terms_ = 2 * contacts_of_all;
  auto& own = records_.template of<T>();
  own.make(blocks.bodies().size());
  for (std::size_t b = 0; b < contacts.x.size(); ++b) own.place(b, contacts.x[b], contacts.z[b], grid_);
}

template <class Problem>
template <class T>
void TileCoarseLoads<Problem>::add_contacts(const TiledContacts& contacts, Halo& halo,
                                            TileBlocks<T, dim, spin>& blocks) {
  auto& own = records_.template of<T>();
  own.rest(0, own.at.size());
  const auto work = [&](std::size_t t) {
    const auto of_tile = blocks.of_tile(t);
    CoarseKernels<T, dim, spin>::add_contacts(of_tile.data(), of_tile.size(), blocks.bodies().data(),
                                              own.bodies());
  };
  const auto exchange = [&](int colour) {
    for (auto* of_bodies : {&own.at, &own.along_x, &own.along_z}) {
      halo.start(colour, [&](std::int32_t b) {
        const BodyRecord<T>& record = (*of_bodies)[b];
        return std::array<double, Halo::numbers>{record.x, record.z, record.s};
      });
      halo.finish(colour, [&](std::int32_t b, const auto& numbers) {
        BodyRecord<T>& record = (*of_bodies)[b];
        record.x = static_cast<T>(numbers[0]), record.z = static_cast<T>(numbers[1]);
        record.s = static_cast<T>(numbers[2]);
      });
    }
  };
  each_colour(
      contacts.order.rounds, loops_, work, [](int) {}, exchange);
}

template <class Problem>
template <class T>
std::array<double, 2> TileCoarseLoads<Problem>::bounds(const TiledContacts& contacts,
                                                       const TileBlocks<T, dim, spin>& blocks) {
  std::array<double, 2> bounds{0, 0};
  each_run(contacts, 0, contacts.counts_here.size(), [&](std::size_t begin, std::size_t count) {
    const CoarseBounds of_run =
        coarse_bounds(blocks.bodies().data(), records_.template of<T>().bodies(), begin, count);
    bounds = {std::max(bounds[0], of_run.power), std::max(bounds[1], of_run.energy)};
  });
  ranks_.largest(bounds);
  return bounds;
}

template <class Problem>
template <class T>
std::vector<double> TileCoarseLoads<Problem>::add_up(const TiledContacts& contacts,
                                                     const TileBlocks<T, dim, spin>& blocks) {
  const std::array<double, 2> largest = bounds(contacts, blocks);
  if (!(largest[0] > 0 && largest[1] > 0 && largest[0] < 1e100 && largest[1] < 1e100)) return {};
  const FixedPoint powers(largest[0], terms_), energies(largest[1], terms_);
  constexpr int numbers = entries_of_node + 1;
  const std::size_t length = static_cast<std::size_t>(numbers) * grid_.nodes();
  std::array<std::vector<std::int64_t>, parts> sums;
  const auto share = [](std::size_t count, int part) { return count * part / parts; };
  loops_.each_of(parts, [&](int part) {
    auto& sum = sums[part];
    sum.assign(length, 0);
    const auto add = [&](const CoarseTerms<T>& terms, std::span<const int> cells) {
      const auto whole_energies = energies.rounded(terms.energies);
      const auto whole_powers = powers.rounded(terms.powers);
      for (std::size_t b = 0; b < cells.size(); ++b) {
        for (std::size_t p = 0; p < terms.pairs.size(); ++p)
          sum[numbers * grid_.corner(cells[b], terms.pairs[p].k) + terms.pairs[p].entry] +=
              whole_energies[p][b];
        for (int k = 0; k < 4; ++k)
          sum[numbers * grid_.corner(cells[b], k) + entries_of_node] += whole_powers[k][b];
      }
    };
    const std::size_t all = contacts.counts_here.size();
    each_run(contacts, share(all, part), share(all, part + 1), [&](std::size_t begin, std::size_t count) {
      each_coarse_terms(grid_, blocks.bodies().data(), records_.template of<T>().bodies(), begin, count, add);
    });
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
  add_contacts(contacts, halo, blocks);
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
  auto& own = records_.template of<T>();
  loops_.each(own.at.size(),
              [&](std::size_t begin, std::size_t end) { own.set_factors(begin, end, grid_, field); });
  loops_.each(blocks.all().size(), [&](std::size_t begin, std::size_t end) {
    CoarseKernels<T, dim, spin>::scale(blocks.all().data() + begin, end - begin, own.at.data());
  });
  return true;
}

#define DRUMLIN_INSTANTIATE_FOR(T, Problem)                                                      \
  template bool TileCoarseLoads<Problem>::scale(                                                 \
      const TiledContacts&, Halo&, TileBlocks<T, TileCoarseLoads::dim, TileCoarseLoads::spin>&); \
  template void TileCoarseLoads<Problem>::lay_out(                                               \
      const Problem&, const TiledContacts&, std::int64_t,                                        \
      const TileBlocks<T, TileCoarseLoads::dim, TileCoarseLoads::spin>&);
#define DRUMLIN_INSTANTIATE(Problem)       \
  template class TileCoarseLoads<Problem>; \
  DRUMLIN_INSTANTIATE_FOR(float, Problem)  \
  DRUMLIN_INSTANTIATE_FOR(double, Problem)
DRUMLIN_INSTANTIATE(FrictionlessProblem)
DRUMLIN_INSTANTIATE(CoulombProblem)
DRUMLIN_INSTANTIATE(CoulombSpinProblem)
#undef DRUMLIN_INSTANTIATE
#undef DRUMLIN_INSTANTIATE_FOR

}  // namespace drumlin::particles
