// The pairs of a step at its end: overlap, and which of them are close, piece by piece on any number of
// threads.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "particles/stepping/overlap.hpp"

namespace drumlin {
using namespace particles;
namespace {

/// Discs in a row, of which some pairs of neighbours overlap, some touch nearly, and some are far apart; a
/// plan of groups that know nothing of pieces.
struct Row {
  Bodies bodies;
  std::vector<Candidate> pairs;
  std::vector<std::int32_t> i, j;
  std::vector<double> impulses;
  SweepPlan plan;

  explicit Row(std::size_t count) {
    double x = 0;
    for (std::size_t k = 0; k <= count; ++k) {
      bodies.x.push_back(x), bodies.z.push_back(0), bodies.radius.push_back(0.5);
      bodies.inverse_mass.push_back(1);
      const bool lonely = k >= ClosePairs::piece && k < 2 * ClosePairs::piece;  // a piece without close pairs
      x += lonely || k % 3 == 0 ? 1.5 : k % 3 == 1 ? 1 - 1e-3 * (2 + std::sin(k)) : 1 + 1e-3;
    }
    bodies.v_x = bodies.v_z = std::vector<double>(bodies.count(), 0);
    for (std::size_t k = 0; k < count; ++k) {
      i.push_back(static_cast<std::int32_t>(k)), j.push_back(static_cast<std::int32_t>(k + 1));
      pairs.push_back({i.back(), j.back(), 0, 0, 0, 0, 0});
      impulses.push_back(k % 3 == 1 ? 1 : 0);
    }
    for (std::size_t first = 0; first < count; first += 37)
      plan.group_start.push_back(static_cast<std::int32_t>(first));
    plan.group_start.push_back(static_cast<std::int32_t>(count));
  }
  PairBodies of() const { return {i, j, static_cast<std::int32_t>(bodies.count())}; }
};

void expect_found(const Row& row, ThreadPool* pool) {
  constexpr double margin = 2e-3;
  OverlapSearch search;
  search.use(pool);
  std::optional<LostGrain> lost;
  const Overlap overlap =
      search.find({row.pairs, row.of(), row.impulses, 1, row.plan}, row.bodies, WallStep{}, {}, margin, lost);
  EXPECT_FALSE(lost);
  std::vector<ClosePair> close;
  std::vector<std::int32_t> earlier;  // close pairs before each pair
  double depths = 0, deepest = 0;
  int loaded = 0;
  for (std::size_t k = 0; k < row.pairs.size(); ++k) {
    const double gap = row.bodies.x[k + 1] - row.bodies.x[k] - 1;
    earlier.push_back(static_cast<std::int32_t>(close.size()));
    if (gap < margin) close.push_back({row.pairs[k].i, row.pairs[k].j, gap, -1, 0});
    if (row.impulses[k] == 0) continue;
    depths += std::max(0.0, -gap), deepest = std::max(deepest, -gap);
    ++loaded;
  }
  earlier.push_back(static_cast<std::int32_t>(close.size()));
  EXPECT_EQ(overlap.loaded, loaded);
  EXPECT_NEAR(overlap.mean, depths / loaded, 1e-12);
  EXPECT_NEAR(overlap.max, deepest, 1e-10);
  const ClosePairs found = search.close();
  ASSERT_EQ(found.count(), close.size());
  EXPECT_TRUE(found.overlap);
  std::size_t k = 0;
  for (int p = 0; p < found.pieces(); ++p)
    for (const ClosePair& pair : found.of(p)) {
      ASSERT_EQ(pair.i, close[k].i);
      ASSERT_NEAR(pair.gap, close[k].gap, 1e-10);
      ++k;
    }
  EXPECT_EQ(k, close.size());
  ASSERT_EQ(search.plan().group_start.size(), row.plan.group_start.size());
  for (std::size_t g = 0; g < row.plan.group_start.size(); ++g)
    ASSERT_EQ(search.plan().group_start[g], earlier[row.plan.group_start[g]]) << g;
}

TEST(OverlapSearch, FindsClosePairsAndTheirGroupsInPieces) {
  for (const std::size_t count : {3UL, 1023UL, 1024UL, 2500UL, 5120UL}) {
    const Row row(count);
    expect_found(row, nullptr);
    for (const int threads : {2, 5}) {
      ThreadPool pool(threads);
      expect_found(row, &pool);
    }
  }
}

TEST(OverlapSearch, WithoutPairsFindsNothing) {
  const Row row(0);
  OverlapSearch search;
  std::optional<LostGrain> lost;
  const Overlap overlap =
      search.find({row.pairs, row.of(), row.impulses, 1, row.plan}, row.bodies, WallStep{}, {}, 1e-3, lost);
  EXPECT_EQ(overlap.loaded, 0);
  EXPECT_EQ(search.close().count(), 0U);
  EXPECT_FALSE(search.close().overlap);
}

}  // namespace
}  // namespace drumlin
