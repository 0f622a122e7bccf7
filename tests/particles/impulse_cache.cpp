// Impulses are found again by the pairs that carried them.
#include "particles/stepping/impulse_cache.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace drumlin {
using namespace particles;
namespace {

using Pair = std::pair<std::int32_t, std::int32_t>;

Candidate pair_of(std::int32_t i, std::int32_t j) { return {i, j, 0, 0, 1, 0, 0}; }

/// Some of all pairs of `bodies` bodies and three walls, in the order of (i, j): each with the odds given.
std::vector<Candidate> some_pairs(int bodies, double odds, unsigned seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution taken(odds);
  std::vector<Candidate> pairs;
  for (int i = 0; i < bodies; ++i)
    for (int j = -3; j < bodies; ++j)
      if ((j < 0 || j > i) && taken(random)) pairs.push_back(pair_of(i, j));
  return pairs;
}

/// Remembers pairs with impulses (10 i + j, -1), solved from the last to the first.
ImpulseCache remembered(const std::vector<Candidate>& pairs, double time_step) {
  std::vector<std::int32_t> i, j, order;
  std::vector<double> impulses;
  for (const Candidate& pair : pairs) i.push_back(pair.i), j.push_back(pair.j);
  for (std::size_t a = pairs.size(); a-- > 0;) {
    order.push_back(static_cast<std::int32_t>(a));
    impulses.insert(impulses.end(), {10.0 * i[a] + j[a], -1});
  }
  ImpulseCache memory;
  save_contacts(i, j, order, impulses, time_step, ParallelLoops(), memory);
  return memory;
}

void expect_loads(const std::vector<Candidate>& pairs, const std::vector<Candidate>& known,
                  const SavedLoads& loads) {
  std::map<Pair, double> carried;
  for (const Candidate& pair : known) carried[{pair.i, pair.j}] = 2 * (10.0 * pair.i + pair.j);
  for (std::size_t a = 0; a < pairs.size(); ++a) {
    const auto found = carried.find({pairs[a].i, pairs[a].j});
    EXPECT_EQ(loads.of(static_cast<std::int32_t>(a)), found == carried.end() ? 0 : found->second)
        << pairs[a].i << ", " << pairs[a].j;
  }
}

TEST(ImpulseCache, FindsPairsInTheirOrderAndInAnyOther) {
  const auto before = some_pairs(60, 0.3, 1);
  const ImpulseCache memory = remembered(before, 0.5);
  EXPECT_TRUE(std::is_sorted(memory.i.begin(), memory.i.end()));
  auto now = some_pairs(60, 0.3, 2);
  WarmStarts warm_starts;
  warm_starts.find(memory, now);
  expect_loads(now, before, warm_starts.loads(memory, 2, 1));
  std::shuffle(now.begin(), now.end(), std::mt19937(3));
  warm_starts.find(memory, now);
  expect_loads(now, before, warm_starts.loads(memory, 2, 1));
  warm_starts.find({}, now);
  expect_loads(now, {}, warm_starts.loads({}, 2, 1));
}

TEST(ImpulseCache, FindsPairsThatAreAdded) {
  const auto before = some_pairs(40, 0.5, 4), now = some_pairs(40, 0.5, 5);
  const ImpulseCache memory = remembered(before, 0.5);
  std::vector<Candidate> first;
  std::vector<std::int32_t> added;
  std::vector<Candidate> pairs_added;
  for (std::size_t a = 0; a < now.size(); ++a)
    if (a % 7 == 3 || a + 1 == now.size())
      added.push_back(static_cast<std::int32_t>(a)), pairs_added.push_back(now[a]);
    else
      first.push_back(now[a]);
  WarmStarts warm_starts;
  warm_starts.find(memory, first);
  warm_starts.find_added(memory, added, pairs_added);
  expect_loads(now, before, warm_starts.loads(memory, 2, 1));
}

TEST(ImpulseCache, WarmStartsInTheOrderOfTheSolve) {
  const auto pairs = some_pairs(20, 0.5, 6);
  const ImpulseCache memory = remembered(pairs, 0.5);
  std::vector<std::int32_t> order;
  for (std::size_t a = 0; a < pairs.size(); ++a) order.push_back(static_cast<std::int32_t>(a));
  std::shuffle(order.begin(), order.end(), std::mt19937(7));
  WarmStarts warm_starts;
  warm_starts.find(memory, pairs);
  std::vector<double> impulses;
  warm_starts.warm_start(memory, 2, 1, order, impulses);
  ASSERT_EQ(impulses.size(), 2 * pairs.size());
  for (std::size_t a = 0; a < pairs.size(); ++a) {
    EXPECT_EQ(impulses[2 * a], 2 * (10.0 * pairs[order[a]].i + pairs[order[a]].j));
    EXPECT_EQ(impulses[2 * a + 1], -2);
  }
}

}  // namespace
}  // namespace drumlin
