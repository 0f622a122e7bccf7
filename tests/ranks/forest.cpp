#include "particles/distributed/forest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <span>

namespace drumlin::particles {
namespace {

const TileGrid grid{{-3, -1}, 1.5, 4};  // 16 x 16 cells, 8 x 8 tiles

/// The same on all ranks.
std::vector<RankGrain> scattered(int count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> along(0, grid.edge());
  std::vector<RankGrain> grains;
  for (int k = 0; k < count; ++k)
    grains.push_back({k, grid.origin.x + along(random), grid.origin.z + along(random), 0.1 * k, -0.2 * k,
                      0.3 * k, 0.5, 1.0 + k});
  return grains;
}

std::vector<RankGrain> share_of(const std::vector<RankGrain>& all, const Ranks& ranks) {
  std::vector<RankGrain> own;
  for (std::size_t k = ranks.rank(); k < all.size(); k += ranks.count()) own.push_back(all[k]);
  return own;
}

/// Every grain is where `all` has it, once; a rank owns those of its tiles and sees all within a cell of
/// them.
void expect_everybody(const Forest& forest, std::span<const RankGrain> own,
                      const std::vector<RankGrain>& all) {
  const Ranks& ranks = forest.ranks();
  const std::int32_t rank = ranks.rank();
  std::vector<std::int64_t> seen(all.size(), 0);
  for (const RankGrain& grain : own) {
    ++seen[grain.id];
    const RankGrain& right = all[grain.id];
    EXPECT_EQ(grain.x, right.x);
    EXPECT_EQ(grain.z, right.z);
    EXPECT_EQ(grain.v_x, right.v_x);
    EXPECT_EQ(grain.spin, right.spin);
    EXPECT_EQ(grain.inverse_mass, right.inverse_mass);
    EXPECT_EQ(forest.tiles().owner_at({grain.x, grain.z}), rank);
  }
  ranks.add(seen);
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](std::int64_t n) { return n == 1; }));
  std::set<std::int64_t> ghosts;
  for (const GhostRecord& ghost : forest.ghosts()) {
    ghosts.insert(ghost.grain.id);
    EXPECT_EQ(ghost.owner, forest.tiles().owner_at({ghost.grain.x, ghost.grain.z}));
    EXPECT_EQ(ghost.grain.v_z, all[ghost.grain.id].v_z);
  }
  EXPECT_EQ(ghosts.size(), forest.ghosts().size());
  for (const RankGrain& grain : all) {
    if (forest.tiles().owner_at({grain.x, grain.z}) == rank) continue;
    bool near = false;
    for (const double dx : {-1.0, 0.0, 1.0})
      for (const double dz : {-1.0, 0.0, 1.0}) {
        const Point p{grain.x + dx * grid.cell, grain.z + dz * grid.cell};
        near = near || (grid.contains(p) && forest.tiles().owner_at(p) == rank);
      }
    if (near) {
      EXPECT_TRUE(ghosts.contains(grain.id)) << grain.id;
    }
  }
}

/// Weights of packings that are wider than high, or higher than wide: they are cut along other axes.
std::vector<std::int64_t> weights_of(bool wide) {
  std::vector<std::int64_t> weights(grid.count(), 1);
  for (std::int32_t tile = 0; tile < grid.count(); ++tile)
    if ((wide ? grid.row(tile) : grid.column(tile)) < 3) weights[tile] = 100;
  return weights;
}

TEST(Forest, OwnsEachGrainOnceAndSeesALayerOfCells) {
  const Ranks ranks;
  const auto all = scattered(600);
  for (const bool wide : {false, true}) {
    Forest forest(ranks, grid, weights_of(wide));
    EXPECT_EQ(forest.place(share_of(all, ranks)).id, -1);
    expect_everybody(forest, forest.take_owned(), all);
  }
  TileGrid narrow = grid;
  narrow.cut = 4;
  Forest forest(ranks, narrow, std::vector<std::int64_t>(narrow.count(), 1));
  EXPECT_EQ(forest.place(share_of(all, ranks)).id, -1);
  expect_everybody(forest, forest.take_owned(), all);
  // One rank has the tiles of a square.
  for (std::int32_t tile = 0; tile < narrow.count(); ++tile)
    EXPECT_EQ(forest.tiles().owner[tile], forest.tiles().owner[tile - narrow.column(tile) % 4]);
}

TEST(Forest, CutsPackingsAcrossTheirLongerSide) {
  const Ranks ranks;
  for (const bool wide : {false, true}) {
    const Forest forest(ranks, grid, weights_of(wide));
    int cut = 0;  // lines of heavy tiles across the longer side that several ranks share
    for (int line = 0; line < grid.rows(); ++line) {
      std::set<std::int32_t> owners;
      for (int k = 0; k < 3; ++k)
        owners.insert(forest.tiles().owner[wide ? k * grid.columns() + line : line * grid.columns() + k]);
      cut += owners.size() > 1;
    }
    EXPECT_LE(cut, 2 * (ranks.count() - 1)) << wide;
    if (ranks.count() == 2) {
      EXPECT_EQ(cut, 0) << wide;  // the line that halves the weight
    }
  }
}

TEST(Forest, CutsAtTheLineThatHalvesTheWeight) {
  const Ranks ranks;
  // An odd number of ranks has no cut at the half.
  if (ranks.count() == 3) GTEST_SKIP() << "three ranks are cut at thirds";
  const int half = ranks.count() / 2;
  for (const int heavy : {1, 2, 3, 8}) {  // columns, which hold about half of the weight, or all of it
    std::vector<std::int64_t> weights(grid.count(), 1);
    for (std::int32_t tile = 0; tile < grid.count(); ++tile)
      if (grid.row(tile) < 4)
        weights[tile] = grid.column(tile) < heavy && heavy < 8 ? 100 * (8 - heavy) / heavy : 100;
    const Forest forest(ranks, grid, weights);
    int cut = 0;
    for (int column = 0; column < grid.columns(); ++column) {
      std::set<bool> sides;
      for (int row = 0; row < 4; ++row)
        sides.insert(forest.tiles().owner[row * grid.columns() + column] >= half);
      cut += sides.size() > 1;
    }
    EXPECT_LE(cut, 2) << heavy;
  }
  // Everywhere the same.
  const Forest forest(ranks, grid, std::vector<std::int64_t>(grid.count(), 1));
  for (std::int32_t tile = 0; tile < grid.count(); ++tile)
    EXPECT_EQ(forest.tiles().owner[tile] >= half, half == 0 || grid.column(tile) >= grid.columns() / 2)
        << tile;
}

TEST(Forest, FollowsGrainsThatMove) {
  const Ranks ranks;
  auto all = scattered(600);
  Forest forest(ranks, grid, weights_of(false));
  ASSERT_EQ(forest.place(share_of(all, ranks)).id, -1);
  std::vector<RankGrain> own = forest.take_owned();
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> step(-0.7, 0.7);
  for (int k = 0; k < 10; ++k) {
    for (RankGrain& grain : all) {
      const double high = grid.edge() - 1e-9;
      grain.x = grid.origin.x + std::clamp(grain.x + step(random) - grid.origin.x, 1e-9, high);
      grain.z = grid.origin.z + std::clamp(grain.z + step(random) - grid.origin.z, 1e-9, high);
      grain.v_x += 1;
    }
    for (RankGrain& grain : own) grain = all[grain.id];
    ASSERT_EQ(forest.move(own).id, -1);
    own = forest.take_owned();
    expect_everybody(forest, own, all);
  }
}

TEST(Forest, TakesGrainsAgainAfterItHadNone) {
  const Ranks ranks;
  auto all = scattered(300);
  Forest forest(ranks, grid, weights_of(true));
  ASSERT_EQ(forest.place(share_of(all, ranks)).id, -1);
  const std::vector<RankGrain> own = forest.take_owned();
  forest.clear();
  EXPECT_TRUE(forest.ghosts().empty());
  for (RankGrain& grain : all)
    std::swap(grain.v_x, grain.v_z), grain.x = 2 * grid.origin.x + grid.edge() - grain.x;
  ASSERT_EQ(forest.place(share_of(all, ranks)).id, -1);
  expect_everybody(forest, forest.take_owned(), all);
}

TEST(Forest, NamesTheFirstGrainThatLeaves) {
  const Ranks ranks;
  // Cells around the grid do not count, nor does what has no cell.
  for (const double beyond : {0.1, 10.0, 90.0}) {
    auto all = scattered(100);
    Forest forest(ranks, grid, std::vector<std::int64_t>(grid.count(), 1));
    ASSERT_EQ(forest.place(share_of(all, ranks)).id, -1);
    all[77].x = grid.origin.x - beyond;
    all[31].z = grid.origin.z + grid.edge() + beyond;
    std::vector<RankGrain> own = forest.take_owned();
    for (RankGrain& grain : own) grain = all[grain.id];
    const GrainOutside outside = forest.move(own);
    EXPECT_EQ(outside.id, 31) << beyond;
    EXPECT_EQ(outside.z, all[31].z) << beyond;
    Forest other(ranks, grid, std::vector<std::int64_t>(grid.count(), 1));
    EXPECT_EQ(other.place(share_of(all, ranks)).id, 31) << beyond;
  }
}

TEST(Tiles, LeaveRoomForGrainsThatDrift) {
  const Reach reach{.largest = 1, .margin = 0.02, .approach = 0.1, .way = 0.1};
  // 1.5 far + near = 1.5 x 1.22 + 1.12, in which far / 2 = 0.61.
  EXPECT_NEAR(least_cell(reach), 2.95, 1e-5);
  EXPECT_NEAR(most_drift(reach, least_cell(reach)), 0, 1e-12);
  EXPECT_NEAR(most_drift(reach, 3), 0.05, 1e-5);
  EXPECT_NEAR(most_drift(reach, 6), 0.61, 1e-12);
  EXPECT_LT(most_drift(reach, 2.9), 0);
}

TEST(Forest, GivesEachRankItsShareOfTheWeight) {
  const Ranks ranks;
  // All the weight in the last rows.
  std::vector<std::int64_t> weights(grid.count(), 1);
  for (std::int32_t tile = 0; tile < grid.count(); ++tile)
    if (grid.row(tile) >= 6) weights[tile] = 100;
  const Forest forest(ranks, grid, weights);
  std::int64_t own = 0, all = 0;
  for (std::int32_t tile = 0; tile < grid.count(); ++tile) {
    all += weights[tile];
    if (forest.tiles().owner[tile] == ranks.rank()) own += weights[tile];
  }
  // Tiles are whole: a share is met to one heavy tile on each side.
  EXPECT_NEAR(static_cast<double>(own), static_cast<double>(all) / ranks.count(), 200);
}

TEST(Tiles, OfOneColourAreATileApart) {
  std::set<int> colours;
  for (std::int32_t tile = 0; tile < grid.count(); ++tile) colours.insert(grid.colour(tile));
  EXPECT_EQ(colours, (std::set<int>{0, 1, 2, 3}));
  for (std::int32_t a = 0; a < grid.count(); ++a)
    for (std::int32_t b = 0; b < a; ++b) {
      if (grid.colour(a) != grid.colour(b)) continue;
      const int side = grid.columns();
      EXPECT_TRUE(std::abs(a % side - b % side) >= 2 || std::abs(a / side - b / side) >= 2);
    }
}

TEST(Tiles, OfEvenColumnsTouchBodiesOfTheirStripAlone) {
  for (const std::int32_t cut : {1, 2, 4}) {
    TileGrid narrow = grid;
    narrow.cut = cut;
    const double tile = narrow.tile_width(), reach = tile / 4;  // tiles are wider than four times that
    for (std::int32_t column = 0; column < narrow.columns(); ++column)
      for (const double along : {-reach, 0.0, tile / 2, tile, tile + reach}) {
        const double x = grid.origin.x + column * tile + along * 0.999;
        if (x < grid.origin.x || x > grid.origin.x + grid.edge()) continue;
        const std::int32_t strip = narrow.strip_of_tile(column), of_body = narrow.strip_of_body(x);
        EXPECT_TRUE(of_body == strip || (column % 2 == 1 && of_body == strip + 1)) << column << " " << along;
      }
  }
}

TEST(Tiles, AreLargeEnoughForTheReachAndNoLargerThanTheyMustBe) {
  const Reach slow{1.1, 0.02, 0.1, 0.05}, fast{1.1, 0.02, 3, 1};
  for (const Reach& reach : {slow, fast}) {
    const TileGrid chosen = tile_grid({0, 0}, 100, reach, 1000);
    EXPECT_GE(chosen.cell, least_cell(reach));
    EXPECT_LE(chosen.cell, std::max(3.0 * reach.largest, 1.5 * least_cell(reach)));
    EXPECT_GE(chosen.edge(), 100);
    EXPECT_EQ(chosen.cut, 1);
  }
}

TEST(Tiles, OfLargeGridsAreHigh) {
  for (const double approach : {0.0, 0.1, 3.0, 50.0}) {
    const Reach reach{1.1, 0.02, approach, 0.05};
    std::set<std::int32_t> cuts;
    for (double edge = 100; edge < 1e5; edge *= 1.3) {
      const TileGrid chosen = tile_grid({0, 0}, edge, reach, 1'000'000'000);
      cuts.insert(chosen.cut);
      EXPECT_GE(chosen.edge(), edge);
      EXPECT_GE(chosen.cell, least_cell(reach));
      EXPECT_EQ(chosen.tile_width(), 2 * chosen.needed_cell());
      EXPECT_GE(chosen.needed_cell(), least_cell(reach));
      EXPECT_LE(chosen.tile_width(), 2 * std::max(3.0 * reach.largest, 1.5 * least_cell(reach)));
    }
    EXPECT_EQ(cuts, (std::set<std::int32_t>{1, 2, 4}));
  }
}

/// Two grains on a floor of two kilometres, and of as many as a scene can name.
TEST(Tiles, AreFewWhereGrainsAre) {
  for (const double edge : {1e4, 1e6, 1e12}) {
    const TileGrid chosen = tile_grid({-edge / 2, -edge / 2}, edge, {1, 0.02, 0.1, 0.05}, 2);
    EXPECT_LE(chosen.count(), 4200);
    EXPECT_GE(chosen.count(), 1000);
    EXPECT_GE(chosen.edge(), edge);
    EXPECT_GE(chosen.needed_cell(), least_cell({1, 0.02, 0.1, 0.05}));
  }
}

}  // namespace
}  // namespace drumlin::particles
