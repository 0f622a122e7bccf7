#include "particles/distributed/tile_blocks.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "particles/contact/problems.hpp"
#include "particles/solver/contact_blocks.hpp"

namespace drumlin::particles {

template <class T, int dim, bool spin>
template <class Problem>
void TileBlocks<T, dim, spin>::pack_bodies(const Problem& problem, std::size_t tiles) {
  const auto& W = problem.W;
  moving_ = W.fixed();
  require_offsets<T>(moving_ + Block::width * tiles);
  bodies_.assign(moving_ + Block::width * tiles, {});
  for (std::int32_t b = 0; b < W.fixed(); ++b) bodies_[b].inverse_mass = static_cast<T>(W.inverse_mass[b]);
  before_.resize(moving_);
}

template <class T, int dim, bool spin>
template <class Problem>
void TileBlocks<T, dim, spin>::colour(const Problem& problem, const TileRange& tile) {
  constexpr int most = 64;  // a body with more contacts is served in rounds
  constexpr std::int8_t none = -1, placed = -2;
  const auto& W = problem.W;
  const auto each_left = [&](auto work) {
    for (std::int32_t a = tile.begin; a < tile.end; ++a)
      if (colour_[a] == none) work(a, W.i[a], W.j[a]);
  };
  std::fill(colour_.begin() + tile.begin, colour_.begin() + tile.end, none);
  for (std::int32_t first = tile.begin; first < tile.end;) {
    each_left([&](std::int32_t, std::int32_t i, std::int32_t j) { used_[i] = used_[j] = 0; });
    std::array<std::int32_t, most> count{};
    each_left([&](std::int32_t a, std::int32_t i, std::int32_t j) {
      used_[W.fixed()] = 0;  // walls are not shared
      const int own = std::countr_one(used_[i] | used_[j]);
      if (own == most) return;
      used_[i] |= std::uint64_t{1} << own, used_[j] |= std::uint64_t{1} << own;
      colour_[a] = static_cast<std::int8_t>(own);
      ++count[own];
    });
    std::array<std::int32_t, most> place{};
    for (int c = 0; c < most && count[c] > 0; ++c) {
      place[c] = first;
      first += count[c];
      group_end_.push_back(first);
      groups_.push_back((count[c] + Block::width - 1) / Block::width);
    }
    for (std::int32_t a = tile.begin; a < tile.end; ++a)
      if (const std::int8_t own = std::exchange(colour_[a], colour_[a] == none ? none : placed); own >= 0)
        order_[place[own]++] = a;
  }
}

template <class T, int dim, bool spin>
template <class Problem>
void TileBlocks<T, dim, spin>::pack_place(const Problem& problem, std::int32_t c, std::int32_t fixed,
                                          std::span<const double> r, std::size_t place) {
  const auto& W = problem.W;
  const auto k = static_cast<std::int32_t>(place % Block::width);
  contact_[place] = c;
  const std::int32_t i = c >= 0 ? W.i[c] : fixed + k;
  const std::int32_t j = c >= 0 && W.j[c] != W.fixed() ? W.j[c] : fixed + k;
  set_place(problem, c, i, j, r, blocks_[place / Block::width], k);
}

template <class T, int dim, bool spin>
template <class Problem>
void TileBlocks<T, dim, spin>::pack_tile(const Problem& problem, std::span<const double> r,
                                         std::size_t tile) {
  constexpr int width = Block::width;
  const auto fixed = static_cast<std::int32_t>(moving_ + width * tile);
  std::size_t place = width * tiles_[tile].block;
  for (std::size_t g = tiles_[tile].group; g < tiles_[tile + 1].group; ++g) {
    for (std::int32_t a = g == 0 ? 0 : group_end_[g - 1]; a < group_end_[g]; ++a)
      pack_place(problem, order_[a], fixed, r, place++);
    while (place % width != 0) pack_place(problem, -1, fixed, r, place++);
  }
}

template <class T, int dim, bool spin>
template <class Problem>
void TileBlocks<T, dim, spin>::pack(const Problem& problem, std::span<const TileRange> tiles,
                                    std::span<const double> r, const TeamLoops& loops) {
  pack_bodies(problem, tiles.size());
  tiles_.clear(), groups_.clear(), group_end_.clear();
  order_.resize(problem.contacts()), colour_.resize(problem.contacts());
  used_.resize(problem.W.inverse_mass.size());
  std::size_t blocks = 0;
  for (const TileRange& tile : tiles) {
    const std::size_t first = groups_.size();
    tiles_.push_back({blocks, first});
    colour(problem, tile);
    for (std::size_t g = first; g < groups_.size(); ++g) blocks += groups_[g];
  }
  tiles_.push_back({blocks, groups_.size()});
  blocks_.resize(blocks), kept_.resize(blocks), contact_.resize(blocks * Block::width);
  loops.each_of(static_cast<int>(tiles.size()), [&](int tile) { pack_tile(problem, r, tile); });
}

template <class T, int dim, bool spin>
template <class Problem>
void TileBlocks<T, dim, spin>::unpack(const Problem& problem, bool kept, std::vector<double>& r,
                                      const TeamLoops& loops) const {
  constexpr int width = Block::width;
  loops.each(contact_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      if (contact_[p] < 0) continue;
      const Impulses& block = kept ? kept_[p / width] : blocks_[p / width].r;
      hold_to_cone(problem, contact_[p], impulses_at(block, p % width), r);
    }
  });
}

template <class T, int dim, bool spin>
void TileBlocks<T, dim, spin>::load(std::size_t tile) {
  const auto blocks = of_tile(tile);
  Kernels::load(blocks.data(), blocks.size(), bodies_.data());
}

template <class T, int dim, bool spin>
double TileBlocks<T, dim, spin>::sweep(std::size_t tile, T beta, SweepExtrapolation how) {
  const auto groups =
      std::span(groups_).subspan(tiles_[tile].group, tiles_[tile + 1].group - tiles_[tile].group);
  return Kernels::sweep(of_tile(tile).data(), groups, bodies_.data(), beta, how);
}

template <class T, int dim, bool spin>
ResidualEstimate TileBlocks<T, dim, spin>::residual(std::size_t tile) const {
  return Kernels::residual(blocks_.data() + tiles_[tile].block, tiles_[tile + 1].block - tiles_[tile].block,
                           bodies_.data());
}

template <class T, int dim, bool spin>
void TileBlocks<T, dim, spin>::keep(std::size_t tile) {
  for (std::size_t b = tiles_[tile].block; b < tiles_[tile + 1].block; ++b) kept_[b] = blocks_[b].r;
}

template <class T, int dim, bool spin>
void TileBlocks<T, dim, spin>::rest(const TeamLoops& loops) {
  loops.each(bodies_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) bodies_[b].x = bodies_[b].z = bodies_[b].s = 0;
  });
}

template <class T, int dim, bool spin>
void TileBlocks<T, dim, spin>::start() {
  std::copy_n(bodies_.begin(), moving_, before_.begin());
}

template <class T, int dim, bool spin>
void TileBlocks<T, dim, spin>::go_on(const TileStrip& strip, T beta) {
  const auto [begin, end] = strip.bodies;
  Kernels::go_on(bodies_.data() + begin, before_.data() + begin, end - begin, beta);
}

#define DRUMLIN_INSTANTIATE(T, dim, spin, Problem)                                           \
  template class TileBlocks<T, dim, spin>;                                                   \
  template void TileBlocks<T, dim, spin>::pack(const Problem&, std::span<const TileRange>,   \
                                               std::span<const double>, const TeamLoops&);   \
  template void TileBlocks<T, dim, spin>::unpack(const Problem&, bool, std::vector<double>&, \
                                                 const TeamLoops&) const;
DRUMLIN_INSTANTIATE(float, 1, false, FrictionlessProblem)
DRUMLIN_INSTANTIATE(double, 1, false, FrictionlessProblem)
DRUMLIN_INSTANTIATE(float, 2, false, CoulombProblem)
DRUMLIN_INSTANTIATE(double, 2, false, CoulombProblem)
DRUMLIN_INSTANTIATE(float, 2, true, CoulombSpinProblem)
DRUMLIN_INSTANTIATE(double, 2, true, CoulombSpinProblem)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
