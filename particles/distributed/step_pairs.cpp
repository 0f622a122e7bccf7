#include "particles/distributed/step_pairs.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "particles/detection/open_gaps.hpp"
#include "particles/parallel/work_memory.hpp"

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
                                        const HomedPairs& homed, std::span<const char> uses,
                                        const TileGrid& grid, std::int32_t rank) {
  const auto& [homes, mine] = homed;
  std::vector<char> shared(seen.owner.size());
  bool any = mine.size() < candidates.size();
  for (std::size_t b = 0; b < shared.size(); ++b) any |= shared[b] = uses[b] && seen.owner[b] != rank;
  std::vector<SharedTouch> touches;
  if (!any) return touches;
  const auto each_body = [&](std::size_t a, auto visit) {
    visit(candidates[a].i);
    if (candidates[a].j >= 0) visit(candidates[a].j);
  };
  for (std::size_t a = 0; a < candidates.size(); ++a)
    if (homes[a].owner != rank) each_body(a, [&](std::int32_t b) { shared[b] = uses[b]; });
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

Home home_of(const Candidate& pair, const SeenGrains& seen, const TileMap& tiles) {
  const std::int32_t tile = tiles.grid.tile_at(middle_of(pair, seen.bodies));
  return {tile, tiles.owner[tile]};
}

}  // namespace

void find_homes(const SeenGrains& seen, std::span<const Candidate> candidates, const TileMap& tiles,
                std::int32_t rank, HomedPairs& found) {
  resize_closely(found.homes, candidates.size()), resize_closely(found.mine, candidates.size());
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

/// Of each seen grain that a rank uses its strip; -1 for the others.
std::vector<std::int32_t> strips_of_used(const SeenGrains& seen, const TileGrid& grid,
                                         std::span<const char> uses) {
  std::vector<std::int32_t> strips(uses.size(), -1);
  for (std::size_t b = 0; b < uses.size(); ++b)
    if (uses[b]) strips[b] = grid.strip_of_body(seen.bodies.x[b]);
  return strips;
}

/// Tiles with places for their contacts, by strip and colour, and the contacts in them in the order of (i,
/// j). Bodies are those seen.
void sort_into_tiles(std::span<const Candidate> candidates, const HomedPairs& homed, const TileMap& tiles,
                     std::span<const char> border_tile, RankPairs& own) {
  const auto& [homes, mine] = homed;
  std::vector<std::int32_t> count(tiles.owner.size(), 0);
  for (const std::int32_t a : mine) ++count[homes[a].tile];
  own.tiles.clear();
  for (std::size_t tile = 0; tile < count.size(); ++tile)
    if (count[tile] > 0) {
      const auto t = static_cast<std::int32_t>(tile);
      own.tiles.push_back({t, 0, count[tile], tiles.grid.colour(t), border_tile[tile] != 0});
    }
  const auto rank_of = [&](const TileRange& range) {
    return std::tuple(tiles.grid.strip_of_tile(range.tile), range.colour, range.tile);
  };
  std::sort(own.tiles.begin(), own.tiles.end(),
            [&](const TileRange& a, const TileRange& b) { return rank_of(a) < rank_of(b); });
  std::int32_t place = 0;
  for (TileRange& range : own.tiles) {
    count[range.tile] = range.begin = place;
    place = range.end += place;
  }
  resize_closely(own.pairs, mine.size()), resize_closely(own.order, mine.size());
  for (std::size_t m = 0; m < mine.size(); ++m)
    own.order[count[homes[mine[m]].tile]++] = static_cast<std::int32_t>(m);
  for (std::size_t a = 0; a < mine.size(); ++a) own.pairs[a] = candidates[mine[own.order[a]]];
}

/// `strip_of` each seen grain as above; `at_border` of those that other ranks use, too.
void find_strips(const TileGrid& grid, std::span<const std::int32_t> strip_of,
                 std::span<const char> at_border, RankPairs& own) {
  std::vector<TileStrip> strips(grid.strips());
  for (std::size_t b = 0; b < strip_of.size(); ++b)
    if (strip_of[b] >= 0) {
      TileStrip& strip = strips[strip_of[b]];
      ++strip.bodies.end;
      strip.border |= at_border[b] != 0;
    }
  for (const TileRange& tile : own.tiles) {
    TileStrip& strip = strips[grid.strip_of_tile(tile.tile)];
    ++strip.phases[tile.colour / 2].end;
    strip.border |= tile.border;
  }
  TileStrip::Range bodies, tiles;
  const auto append = [](TileStrip::Range& all, TileStrip::Range& range) {
    range = {all.end, all.end + range.end};
    all = range;
  };
  for (TileStrip& strip : strips) {
    append(bodies, strip.bodies);
    for (TileStrip::Range& phase : strip.phases) append(tiles, phase);
  }
  own.tile_order = {rounds_of(own.tiles), std::move(strips)};
}

/// Lists the bodies that a rank uses strip by strip: as its contacts first touch them, so that those of a
/// tile stand together, and then its other grains.
void number_bodies(std::span<const std::int32_t> strip_of, RankPairs& own) {
  own.in_used.assign(strip_of.size(), -1);
  std::vector<std::int32_t> next;
  for (const TileStrip& strip : own.tile_order.strips) next.push_back(strip.bodies.begin);
  resize_closely(own.used, own.tile_order.strips.back().bodies.end);
  const auto use = [&](std::int32_t b) {
    std::int32_t& place = own.in_used[b];
    if (place < 0) {
      place = next[strip_of[b]]++;
      own.used[place] = b;
    }
    return place;
  };
  for (Candidate& pair : own.pairs) {
    pair.i = use(pair.i);
    if (pair.j >= 0) pair.j = use(pair.j);
  }
  for (std::size_t b = 0; b < strip_of.size(); ++b)
    if (strip_of[b] >= 0) use(static_cast<std::int32_t>(b));
}

}  // namespace

void find_rank_pairs(const SeenGrains& seen, std::span<const Candidate> candidates, const HomedPairs& homed,
                     const TileMap& tiles, std::int32_t rank, RankPairs& own) {
  const std::vector<char> uses = used_of_seen(seen, candidates, homed.mine, rank);
  auto touches = shared_touches(seen, candidates, homed, uses, tiles.grid, rank);
  std::vector<char> at_border(seen.owner.size(), 0), border_tile(tiles.owner.size(), 0);
  for (const SharedTouch& touch : touches) at_border[touch.body] = 1;
  if (!touches.empty())
    for (const std::int32_t a : homed.mine) {
      const Candidate& pair = candidates[a];
      if (at_border[pair.i] || (pair.j >= 0 && at_border[pair.j])) border_tile[homed.homes[a].tile] = 1;
    }
  const std::vector<std::int32_t> strip_of = strips_of_used(seen, tiles.grid, uses);
  sort_into_tiles(candidates, homed, tiles, border_tile, own);
  find_strips(tiles.grid, strip_of, at_border, own);
  number_bodies(strip_of, own);
  for (SharedTouch& touch : touches) touch.body = own.in_used[touch.body];
  own.halo = halo_plan(touches, rank);
}

}  // namespace drumlin::particles
