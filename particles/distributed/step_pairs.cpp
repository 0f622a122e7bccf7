#include "particles/distributed/step_pairs.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "particles/detection/open_gaps.hpp"

namespace drumlin::particles {
namespace {

using Home = HomedPairs::Home;

/// Of each seen grain, whether this rank uses it: its own ones and those that its contacts touch.
std::vector<char> used_of_seen(const SeenGrains& seen, std::span<const Candidate> candidates,
                               std::span<const std::int32_t> mine, std::int32_t rank) {
  std::vector<char> uses(seen.owner.size());
  for (std::size_t b = 0; b < uses.size(); ++b) uses[b] = seen.owner[b] == rank;
  for (const std::int32_t a : mine) {
    uses[candidates[a].i] = 1;
    if (candidates[a].j >= 0) uses[candidates[a].j] = 1;
  }
  return uses;
}

/// Touches of the grains that this rank uses and others may, in the order of the seen grains, by which they
/// name them.
std::vector<SharedTouch> shared_touches(const SeenGrains& seen, std::span<const Candidate> candidates,
                                        std::span<const Home> homes, std::span<const char> uses,
                                        const TileGrid& grid, std::int32_t rank) {
  std::vector<char> shared(seen.owner.size());
  for (std::size_t b = 0; b < shared.size(); ++b) shared[b] = uses[b] && seen.owner[b] != rank;
  const auto each_body = [&](std::size_t a, auto visit) {
    visit(candidates[a].i);
    if (candidates[a].j >= 0) visit(candidates[a].j);
  };
  for (std::size_t a = 0; a < candidates.size(); ++a)
    if (homes[a].owner != rank) each_body(a, [&](std::int32_t b) { shared[b] = uses[b]; });
  std::vector<SharedTouch> touches;
  for (std::size_t b = 0; b < shared.size(); ++b)
    if (shared[b]) touches.push_back({static_cast<std::int32_t>(b), seen.owner[b], -1});
  for (std::size_t a = 0; a < candidates.size(); ++a)
    each_body(a, [&](std::int32_t b) {
      if (shared[b]) touches.push_back({b, homes[a].owner, grid.colour(homes[a].tile)});
    });
  std::stable_sort(touches.begin(), touches.end(),
                   [](const SharedTouch& a, const SharedTouch& b) { return a.body < b.body; });
  return touches;
}

}  // namespace

Point middle_of(const Candidate& pair, const Bodies& bodies) {
  if (pair.j < 0) return {bodies.x[pair.i], bodies.z[pair.i]};
  return {(bodies.x[pair.i] + bodies.x[pair.j]) / 2, (bodies.z[pair.i] + bodies.z[pair.j]) / 2};
}

namespace {

Home home_of(const Candidate& pair, const SeenGrains& seen, const TileMap& tiles) {
  const std::int32_t tile = tiles.grid.tile_at(middle_of(pair, seen.bodies));
  return {tile, tiles.owner[tile]};
}

}  // namespace

void find_homes(const SeenGrains& seen, std::span<const Candidate> candidates, const TileMap& tiles,
                std::int32_t rank, HomedPairs& found) {
  found.homes.resize(candidates.size()), found.mine.resize(candidates.size());
  std::size_t own = 0;
  for (std::size_t a = 0; a < candidates.size(); ++a) {
    found.homes[a] = home_of(candidates[a], seen, tiles);
    found.mine[own] = static_cast<std::int32_t>(a);
    own += found.homes[a].owner == rank;
  }
  found.mine.resize(own);
}

std::vector<std::int32_t> find_homes_of_added(const SeenGrains& seen, std::span<const Candidate> candidates,
                                              std::span<const std::int32_t> added, const TileMap& tiles,
                                              std::int32_t rank, HomedPairs& found) {
  open_gaps(found.homes, added.size(), [&](std::size_t k, std::size_t) { return added[k]; });
  std::vector<std::int32_t> mine, of_added;
  mine.reserve(found.mine.size() + added.size());
  std::size_t next = 0;
  const auto take = [&](std::int32_t a) {
    found.homes[a] = home_of(candidates[a], seen, tiles);
    if (found.homes[a].owner != rank) return;
    of_added.push_back(static_cast<std::int32_t>(mine.size()));
    mine.push_back(a);
  };
  for (const std::int32_t old : found.mine) {
    while (next < added.size() && added[next] <= old + static_cast<std::int32_t>(next)) take(added[next++]);
    mine.push_back(old + static_cast<std::int32_t>(next));
  }
  while (next < added.size()) take(added[next++]);
  found.mine = std::move(mine);
  return of_added;
}

namespace {

/// Tiles in the order of the sweeps, with places for their contacts, and the contacts in them in the order of
/// (i, j). Bodies are those seen.
void sort_into_tiles(std::span<const Candidate> candidates, const HomedPairs& homed, const TileMap& tiles,
                     std::span<const char> border_tile, RankPairs& own) {
  const auto& [homes, mine] = homed;
  std::vector<std::int32_t> count(tiles.owner.size(), 0);
  for (const std::int32_t a : mine) ++count[homes[a].tile];
  for (std::size_t tile = 0; tile < count.size(); ++tile)
    if (count[tile] > 0) {
      const auto t = static_cast<std::int32_t>(tile);
      own.tiles.push_back({t, 0, count[tile], tiles.grid.colour(t), border_tile[tile] != 0});
    }
  std::sort(own.tiles.begin(), own.tiles.end(), [](const TileRange& a, const TileRange& b) {
    return std::tuple(a.colour, !a.border, a.tile) < std::tuple(b.colour, !b.border, b.tile);
  });
  std::int32_t place = 0;
  for (TileRange& range : own.tiles) {
    count[range.tile] = range.begin = place;
    place = range.end += place;
  }
  own.pairs.resize(mine.size()), own.order.resize(mine.size());
  for (std::size_t m = 0; m < mine.size(); ++m) {
    const std::int32_t a = mine[m], to = count[homes[a].tile]++;
    own.order[to] = static_cast<std::int32_t>(m);
    own.pairs[to] = candidates[a];
  }
}

/// Lists the bodies that the pairs touch as they first do, so that those of a tile stand together, and then
/// the rank's other grains.
void number_bodies(const SeenGrains& seen, std::int32_t rank, RankPairs& own) {
  own.in_used.assign(seen.owner.size(), -1);
  const auto use = [&](std::int32_t b) {
    if (own.in_used[b] < 0) {
      own.in_used[b] = static_cast<std::int32_t>(own.used.size());
      own.used.push_back(b);
    }
    return own.in_used[b];
  };
  for (Candidate& pair : own.pairs) {
    pair.i = use(pair.i);
    if (pair.j >= 0) pair.j = use(pair.j);
  }
  for (std::size_t b = 0; b < seen.owner.size(); ++b)
    if (seen.owner[b] == rank) use(static_cast<std::int32_t>(b));
}

}  // namespace

RankPairs rank_pairs(const SeenGrains& seen, std::span<const Candidate> candidates, const HomedPairs& homed,
                     const TileMap& tiles, std::int32_t rank) {
  RankPairs own;
  const auto& [homes, mine] = homed;
  const std::vector<char> uses = used_of_seen(seen, candidates, mine, rank);
  auto touches = shared_touches(seen, candidates, homes, uses, tiles.grid, rank);
  std::vector<char> at_border(seen.owner.size(), 0), border_tile(tiles.owner.size(), 0);
  for (const SharedTouch& touch : touches) at_border[touch.body] = 1;
  for (const std::int32_t a : mine) {
    const Candidate& pair = candidates[a];
    if (at_border[pair.i] || (pair.j >= 0 && at_border[pair.j])) border_tile[homes[a].tile] = 1;
  }
  sort_into_tiles(candidates, homed, tiles, border_tile, own);
  number_bodies(seen, rank, own);
  for (SharedTouch& touch : touches) touch.body = own.in_used[touch.body];
  own.halo = halo_plan(touches, rank);
  return own;
}

Bodies used_bodies(const SeenGrains& seen, std::span<const std::int32_t> used) {
  const auto taken = [&](const auto& values) {
    std::remove_cvref_t<decltype(values)> some;
    if (values.empty()) return some;
    some.resize(used.size());
    for (std::size_t b = 0; b < used.size(); ++b) some[b] = values[used[b]];
    return some;
  };
  const Bodies& all = seen.bodies;
  return {taken(all.x),    taken(all.z),      taken(all.v_x),          taken(all.v_z),
          taken(all.spin), taken(all.radius), taken(all.inverse_mass), taken(all.material),
          taken(all.id)};
}

}  // namespace drumlin::particles
