// Impacts on ranks against those of one process, where they spread over all ranks.
#include "particles/distributed/gathered_impacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace drumlin::particles {
namespace {

/// A row of discs of alternating masses that touch; some come in from the left, and one in the middle has
/// been thrown to the right.
struct Row {
  explicit Row(int discs) {
    for (int b = 0; b < discs; ++b) {
      bodies.x.push_back(b), bodies.z.push_back(0);
      bodies.v_x.push_back(b < 2 ? 1 : b == discs / 2 ? 0.25 : 0), bodies.v_z.push_back(0);
      bodies.spin.push_back(b % 3 == 0 ? 0.1 : 0);
      bodies.radius.push_back(0.5), bodies.inverse_mass.push_back(1 + 0.25 * (b % 2));
      bodies.id.push_back(b);
      if (b > 0) pairs.push_back({b - 1, b, 0, -1, 0, 0, 0});
    }
    laws.gravity = Point{0, -1};
    laws.friction = PairLaw{1, {0.3}, {0.3}};
    laws.restitution = RestitutionLaw{PairLaw{1, {0.8}, {0.8}}};
    laws.spin.emplace();
  }
  Bodies bodies;
  std::vector<Candidate> pairs;
  StepLaws laws;
  WallStep walls;
};

TEST(GatheredImpacts, AreThoseOfOneProcessToTheLastBit) {
  const Ranks ranks;
  constexpr int discs = 90;
  const Row row(discs);
  const double time_step = 1e-3;
  FreeMotion free;
  // One process.
  Bodies bodies = row.bodies;
  StepContacts contacts;
  contacts.pairs = row.pairs;
  std::vector<std::int32_t> place(row.pairs.size());
  std::iota(place.begin(), place.end(), 0);
  const std::vector<double> none(row.pairs.size(), 0.0);
  Impacts impacts;
  const RememberedLoads unloaded(place, none, 1, 1);
  const StepInput alone{row.laws, bodies, row.walls, {}, free, time_step};
  impacts.resolve({alone, contacts.pairs, unloaded, {}}, {bodies, free.shift, contacts});
  ASSERT_GT(impacts.struck().size(), 60U);  // they go through most of the row
  // A rank has a stretch of pairs, and sees three discs on each side of them.
  const int stretch = ranks.count() - 1 - ranks.rank();  // against the order of the ranks
  const int first = (discs - 1) * stretch / ranks.count(), last = (discs - 1) * (stretch + 1) / ranks.count();
  const int low = std::max(0, first - 3), high = std::min(discs, last + 4);
  Bodies seen;
  std::vector<std::int32_t> place_of(discs, -1);
  for (int b = low; b < high; ++b) {
    place_of[b] = b - low;
    seen.x.push_back(row.bodies.x[b]), seen.z.push_back(row.bodies.z[b]);
    seen.v_x.push_back(row.bodies.v_x[b]), seen.v_z.push_back(row.bodies.v_z[b]);
    seen.spin.push_back(row.bodies.spin[b]), seen.radius.push_back(row.bodies.radius[b]);
    seen.inverse_mass.push_back(row.bodies.inverse_mass[b]), seen.id.push_back(b);
  }
  StepContacts mine;
  for (int a = first; a < last; ++a) {
    Candidate pair = row.pairs[a];
    pair.i -= low, pair.j -= low;
    mine.pairs.push_back(pair);
  }
  GatheredImpacts gathered(ranks);
  FreeMotion free_here;
  const StepInput step{row.laws, seen, row.walls, {}, free_here, time_step};
  const RememberedLoads loads(place, none, 1, 1);
  const auto struck = gathered.resolve(
      {step, loads, seen, free_here.shift, mine, place_of, {{-1, -discs / 2.0}, discs + 1.0, discs}});
  ASSERT_EQ(struck.size(), impacts.struck().size());
  for (std::size_t k = 0; k < struck.size(); ++k) {
    const std::int32_t b = impacts.struck()[k].grain;
    EXPECT_EQ(struck[k].id, b);
    EXPECT_EQ(struck[k].v_x, bodies.v_x[b]);
    EXPECT_EQ(struck[k].v_z, bodies.v_z[b]);
    EXPECT_EQ(struck[k].spin, bodies.spin[b]);
    EXPECT_EQ(struck[k].shift.x, free.shift[b].x);
    EXPECT_EQ(struck[k].shift.z, free.shift[b].z);
    EXPECT_EQ(struck[k].before.x, row.bodies.v_x[b]);
    EXPECT_EQ(struck[k].before.z, row.bodies.v_z[b]);
  }
  EXPECT_EQ(gathered.count(), impacts.count());
  EXPECT_EQ(gathered.counts().times, 1);
  // They reach further than what is sent first.
  EXPECT_TRUE(ranks.count() == 1 || gathered.counts().rounds > 1);
  const auto strikes = gathered.strikes();
  if (ranks.rank() != 0) {
    EXPECT_TRUE(strikes.empty());
    return;
  }
  ASSERT_EQ(strikes.size(), contacts.strikes.size());
  for (std::size_t k = 0; k < contacts.strikes.size(); ++k) {
    EXPECT_EQ(strikes[k].i, contacts.strikes[k].i);
    EXPECT_EQ(strikes[k].j, contacts.strikes[k].j);
    EXPECT_EQ(strikes[k].normal, contacts.strikes[k].normal);
  }
}

/// Two discs meet at each end of a row at rest, and the first ones push on a third: what is far from them is
/// not sent, nor what the rank that resolves them has itself.
TEST(GatheredImpacts, SendThePairsNearTheImpactsAlone) {
  const Ranks ranks;
  if (ranks.count() == 1) return;
  constexpr int discs = 400, half = discs / 2;
  Row row(discs);
  std::fill(row.bodies.v_x.begin(), row.bodies.v_x.end(), 0.0);
  row.bodies.v_x[0] = 1, row.bodies.v_x[1] = 0.5, row.bodies.v_x[discs - 1] = -1;
  for (Candidate& pair : row.pairs) pair.gap = pair.i < 2 || pair.i == discs - 2 ? 0 : 0.1;
  FreeMotion unused;
  // The second rank has the first half of the row, in which more pairs close; the first rank has the others.
  StepContacts mine;
  for (const Candidate& pair : row.pairs)
    if (ranks.rank() == (pair.i < half ? 1 : 0)) mine.pairs.push_back(pair);
  Bodies nothing;
  std::vector<std::int32_t> place(mine.pairs.size()), places(discs, -1);
  std::iota(place.begin(), place.end(), 0);
  if (ranks.rank() < 2) std::iota(places.begin(), places.end(), 0);
  const std::vector<double> none(mine.pairs.size(), 0.0);
  Bodies& seen = ranks.rank() < 2 ? row.bodies : nothing;
  const StepInput step{row.laws, seen, row.walls, {}, unused, 1e-3};
  GatheredImpacts gathered(ranks);
  const RememberedLoads loads(place, none, 1, 1);
  const auto struck =
      gathered.resolve({step, loads, seen, unused.shift, mine, places, {{-1, -half}, discs + 1.0, discs}});
  EXPECT_EQ(struck.size(), 5U);
  if (ranks.rank() == 0) {
    EXPECT_GE(gathered.counts().pairs, 1);
    EXPECT_LE(gathered.counts().pairs, 8);
  } else {
    EXPECT_EQ(gathered.counts().pairs, 0);
  }
  const auto first = static_cast<std::size_t>(gathered.count());
  EXPECT_EQ(gathered.strikes().size(), ranks.rank() == 0 ? first : 0U);
  // Then the other end alone: another rank resolves it, and strikes stand in the order of the calls.
  if (ranks.rank() < 2) row.bodies.v_x[0] = row.bodies.v_x[1] = row.bodies.v_x[2] = 0;
  row.bodies.v_x[discs - 1] = -1, row.bodies.v_x[discs - 2] = 0;
  const auto again =
      gathered.resolve({step, loads, seen, unused.shift, mine, places, {{-1, -half}, discs + 1.0, discs}});
  EXPECT_EQ(again.size(), 2U);
  const auto strikes = gathered.strikes();
  ASSERT_EQ(strikes.size(), ranks.rank() == 0 ? first + 1 : 0U);
  if (ranks.rank() == 0) {
    EXPECT_EQ(strikes.back().j, discs - 1);
  }
}

TEST(NearPlaces, AreThoseAroundSomeDiscsAndHardlyMore) {
  Bodies whole, part;
  whole.x = {-20, 19.9}, whole.z = {-20, 19.9};
  part.x = {1.2, 15}, part.z = {-7, 3.6};  // what another rank sees
  NearPlaces near, of_part;
  near.clear({{-20, -20}, 40, 1000}, whole), of_part.clear({{-20, -20}, 40, 1000}, part);
  const std::vector<Surroundings> places{{{3.3, -4.7}, 5}, {{19.5, 0}, 4}, {{-30, -30}, 2}, {{8, 3}, 0.1}};
  near.mark(places), of_part.mark(places);
  int marked = 0, within = 0;
  for (double x = -19.9; x < 19.9; x += 0.2)
    for (double z = -19.9; z < 19.9; z += 0.2) {
      const bool inside = std::hypot(x - 3.3, z + 4.7) <= 5 || std::hypot(x - 19.5, z) <= 4;
      EXPECT_TRUE(near.marked({x, z}) || !inside) << x << ' ' << z;
      marked += near.marked({x, z}), within += inside;
      if (x > 1.2 && x < 15 && z > -7 && z < 3.6) {
        EXPECT_EQ(of_part.marked({x, z}), near.marked({x, z})) << x << ' ' << z;
      }
    }
  EXPECT_LT(marked, 1.5 * within);
  EXPECT_FALSE(near.marked({-19.9, -19.9}));
  near.clear({{-20, -20}, 40, 1000}, {});
  near.mark(places);  // a rank without bodies
}

/// A few grains far apart do not make a raster of all that lies between them.
TEST(NearPlaces, TakeWiderSquaresWhereGrainsAreFew) {
  Bodies two;
  two.x = {0, 1e6}, two.z = {0, 1e6};
  NearPlaces near;
  near.clear({{0, 0}, 1.1e6, 2}, two);
  near.mark(std::vector<Surroundings>{{{1e6, 1e6}, 5}});
  EXPECT_TRUE(near.marked({1e6, 1e6}));
  EXPECT_FALSE(near.marked({0, 0}));
}

}  // namespace
}  // namespace drumlin::particles
