#include "particles/distributed/tile_blocks.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "particles/contact/problems.hpp"

namespace drumlin::particles {

template <class T, int dim, bool spin>
template <class Problem>
void TileBlocks<T, dim, spin>::pack_bodies(const Problem& problem, std::size_t tiles) {
  const auto& W = problem.W;
  moving_ = W.fixed() + W.fixed() % 2;  // records go in pairs
  bodies_.assign(moving_ + Block::width * tiles, {});
  for (std::int32_t b = 0; b < W.fixed(); ++b) bodies_[b].inverse_mass = static_cast<T>(W.inverse_mass[b]);
  before_.resize(moving_);
}

template <class T, int dim, bool spin>
template <class Problem>
void TileBlocks<T, dim, spin>::colour(const Problem& problem, const TileRange& tile) {
  constexpr int most = 64;  // a body with more contacts is served in rounds
  const auto& W = problem.W;
  std::vector<std::int32_t> served, left;
  for (std::int32_t a = tile.begin; a < tile.end; ++a) served.push_back(a);
  std::vector<std::vector<std::int32_t>> groups;
  for (; !served.empty(); served = std::exchange(left, {})) {
    for (const std::int32_t a : served) {
      used_[W.i[a]] = 0;
      if (W.j[a] != W.fixed()) used_[W.j[a]] = 0;
    }
    groups.clear();
    for (const std::int32_t a : served) {
      const bool pair = W.j[a] != W.fixed();
      const int own = std::countr_one(used_[W.i[a]] | (pair ? used_[W.j[a]] : 0));
      if (own == most) {
        left.push_back(a);
        continue;
      }
      used_[W.i[a]] |= std::uint64_t{1} << own;
      if (pair) used_[W.j[a]] |= std::uint64_t{1} << own;
      if (static_cast<std::size_t>(own) >= groups.size()) groups.resize(own + 1);
      groups[own].push_back(a);
    }
    for (const auto& group : groups) {
      order_.insert(order_.end(), group.begin(), group.end());
      group_end_.push_back(static_cast<std::int32_t>(order_.size()));
      const auto blocks = static_cast<std::int32_t>((group.size() + Block::width - 1) / Block::width);
      groups_.push_back({blocks, blocks});
    }
  }
}

template <class T, int dim, bool spin>
template <class Problem>
void TileBlocks<T, dim, spin>::pack_place(const Problem& problem, std::int32_t c, std::int32_t fixed,
                                          std::span<const double> r, std::size_t place) {
  const auto& W = problem.W;
  Block& block = blocks_[place / Block::width];
  const auto k = static_cast<std::int32_t>(place % Block::width);
  contact_[place] = c;
  const std::int32_t i = c >= 0 ? W.i[c] : fixed + k;
  const std::int32_t j = c >= 0 && W.j[c] != W.fixed() ? W.j[c] : fixed + k;
  block.i[k] = static_cast<std::uint32_t>(i * sizeof(BodyRecord<T>));
  block.j[k] = static_cast<std::uint32_t>(j * sizeof(BodyRecord<T>));
  block.n_x[k] = c >= 0 ? static_cast<T>(W.n_x[c]) : T(0);
  block.n_z[k] = c >= 0 ? static_cast<T>(W.n_z[c]) : T(0);
  block.inverse_W_nn[k] = c >= 0 ? static_cast<T>(W.inverse_W_nn[c]) : T(1);
  for (int e = 0; e < dim; ++e) {
    block.q[e][k] = c >= 0 ? static_cast<T>(problem.q[dim * c + e]) : T(0);
    block.r[e][k] = c >= 0 ? static_cast<T>(r[dim * c + e]) : T(0);
    block.before[e][k] = block.r[e][k];
  }
  if constexpr (dim >= 2) block.mu[k] = c >= 0 ? static_cast<T>(problem.mu[c]) : T(0);
}

template <class T, int dim, bool spin>
template <class Problem>
void TileBlocks<T, dim, spin>::pack_tile(const Problem& problem, std::span<const double> r,
                                         std::size_t tile) {
  constexpr int width = Block::width;
  const auto fixed = static_cast<std::int32_t>(moving_ + width * tile);
  std::size_t place = width * tiles_[tile].block;
  std::vector<std::pair<double, std::int32_t>> open;
  for (std::size_t g = tiles_[tile].group; g < tiles_[tile + 1].group; ++g) {
    open.clear();
    const std::size_t first = place;
    for (std::int32_t a = g == 0 ? 0 : group_end_[g - 1]; a < group_end_[g]; ++a) {
      const std::int32_t c = order_[a];
      if (r[dim * c] == 0)
        open.push_back({problem.q[dim * c], c});
      else
        pack_place(problem, c, fixed, r, place++);
    }
    // As in strips: those that start open stand last, the surest at the end, so that blocks of them can rest.
    if (place > first) std::sort(open.begin(), open.end());
    for (const auto& [q_n, c] : open) pack_place(problem, c, fixed, r, place++);
    while (place % width != 0) pack_place(problem, -1, fixed, r, place++);
  }
}

template <class T, int dim, bool spin>
template <class Problem>
void TileBlocks<T, dim, spin>::pack(const Problem& problem, std::span<const TileRange> tiles,
                                    std::span<const double> r, const TeamLoops& loops) {
  pack_bodies(problem, tiles.size());
  tiles_.clear(), groups_.clear(), order_.clear(), group_end_.clear();
  used_.resize(problem.W.inverse_mass.size());
  std::size_t blocks = 0;
  for (const TileRange& tile : tiles) {
    const std::size_t first = groups_.size();
    tiles_.push_back({blocks, first});
    colour(problem, tile);
    for (std::size_t g = first; g < groups_.size(); ++g) blocks += groups_[g].count;
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
      const std::int32_t c = contact_[p];
      if (c < 0) continue;
      const Impulses& block = kept ? kept_[p / width] : blocks_[p / width].r;
      r[dim * c] = static_cast<double>(block[0][p % width]);
      if constexpr (dim == 2) {
        const double bound = problem.mu[c] * r[2 * c];
        r[2 * c + 1] = std::clamp(static_cast<double>(block[1][p % width]), -bound, bound);
      }
    }
  });
}

template <class T, int dim, bool spin>
void TileBlocks<T, dim, spin>::load(std::size_t tile) {
  const auto blocks = of_tile(tile);
  Kernels::load(blocks.data(), blocks.size(), bodies_.data());
}

template <class T, int dim, bool spin>
double TileBlocks<T, dim, spin>::sweep(std::size_t tile, T beta, bool accelerated) {
  const auto groups =
      std::span(groups_).subspan(tiles_[tile].group, tiles_[tile + 1].group - tiles_[tile].group);
  return Kernels::sweep(of_tile(tile).data(), groups, bodies_.data(), beta, accelerated);
}

template <class T, int dim, bool spin>
void TileBlocks<T, dim, spin>::let_rest(std::size_t tile, bool rest) {
  const Block* first = of_tile(tile).data();
  for (std::size_t g = tiles_[tile].group; g < tiles_[tile + 1].group; ++g) {
    BlockGroup& group = groups_[g];
    group.swept = group.count;
    while (rest && group.swept > 0 && stays_open(first[group.swept - 1])) --group.swept;
    first += group.count;
  }
}

template <class T, int dim, bool spin>
SeenResidual TileBlocks<T, dim, spin>::residual(std::size_t tile) const {
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
void TileBlocks<T, dim, spin>::go_on(T beta, const TeamLoops& loops) {
  // In pairs of records, whatever the pieces of the loop.
  loops.each(moving_ / 2, [&](std::size_t begin, std::size_t end) {
    Kernels::go_on(&bodies_[2 * begin], &before_[2 * begin], 2 * (end - begin), beta);
  });
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
