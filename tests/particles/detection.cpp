// Contact detection: the pairs of its definition and no others, at a cost that grows with the grains alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "particles/detection/contact_list.hpp"
#include "particles/scene/random.hpp"
#include "tests/particles/many_grains.hpp"

namespace drumlin::detection {
namespace {

using namespace particles;
using namespace test;

constexpr double time_step = grains_time_step, margin = 0.02;

std::vector<Candidate> found(ContactDetection& detection, const Grains& g, const Period& period = {}) {
  const DetectionInput input{{}, {}, time_step, margin, period};
  const auto pairs = detection.find(g.bodies, g.v_x, g.v_z, input);
  return {pairs.begin(), pairs.end()};
}

/// The pairs of the definition, from all pairs.
std::map<std::pair<int, int>, double> defined(const Grains& g, const Period& period) {
  const auto count = static_cast<int>(g.count());
  struct Weighed {
    int i, j;
    double gap, reach;
  };
  std::vector<Weighed> all;
  std::vector<double> bound(g.count(), 0.0);
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j) {
      double n_x = 0, n_z = 0;
      const double gap = gap_now({i, j, 0, 0, 0, 0, 0}, g.bodies, {}, period, n_x, n_z);
      const double approach = -(n_x * (g.v_x[i] - g.v_x[j]) + n_z * (g.v_z[i] - g.v_z[j]));
      const double reach = 2 * time_step * std::max(0.0, approach);
      all.push_back({i, j, gap, reach});
      if (gap < margin + reach) bound[i] = std::max(bound[i], reach), bound[j] = std::max(bound[j], reach);
    }
  std::map<std::pair<int, int>, double> pairs;
  for (const Weighed& w : all)
    if (w.gap < margin + w.reach + (bound[w.i] + bound[w.j]) / 2) pairs[{w.i, w.j}] = w.gap;
  return pairs;
}

void expect_defined(const Grains& g, const Period& period, const char* what) {
  ContactDetection detection;
  const auto pairs = found(detection, g, period);
  const auto expected = defined(g, period);
  ASSERT_EQ(pairs.size(), expected.size()) << what;
  auto next = expected.begin();  // a map is in the order of (i, j)
  for (const Candidate& pair : pairs) {
    ASSERT_EQ(std::pair(pair.i, pair.j), next->first) << what;
    EXPECT_NEAR(pair.gap, next->second, 1e-9) << what;
    ++next;
  }
}

TEST(Detection, FindsThePairsOfItsDefinitionAndNoOthers) {
  RandomStream random(11, "test");
  for (const Period& period : {Period{}, Period{-1, 27}}) {
    expect_defined(flowing(700, random), period, "flowing");
    expect_defined(test::falling(700, random), period, "falling");
    expect_defined(scattered(500, random), period, "scattered");
    expect_defined(unlike(700, random), period, "unlike");
    expect_defined(packed(700, 0.02, 0, random), period, "one to fifty");
    Grains bullets = packed(700, 0.2, 1, random);
    for (const std::size_t b : {3, 350, 699}) bullets.v_x[b] = 400, bullets.v_z[b] = -300;
    expect_defined(bullets, period, "bullets");
    Grains stray = packed(300, 0.5, 1, random);
    stray.add(3e6, -2e7, 0.5, 1, 1);
    expect_defined(stray, period, "stray");
  }
  // In a period of one or two cells a cell is its neighbour's neighbour, and a fast grain meets itself.
  for (const double length : {3.2, 2.0}) {
    Grains narrow;
    for (int k = 0; k < 60; ++k)
      narrow.add(random.uniform(-9, 9), k * 0.5, 0.3, random.uniform(-40, 40), random.uniform(-40, 40));
    expect_defined(narrow, {-1, length}, "narrow");
  }
}

TEST(Detection, FindsTheWallsThatGrainsMayMeet) {
  RandomStream random(7, "test");
  const std::vector<Shape> walls{Segment{{3, 3}, {17, 4}}, FixedDisc{{9, 9}, 2}, Container{{9, 9}, 12}};
  const std::vector<ShapeStep> still(walls.size());
  for (const Period& period : {Period{}, Period{1, 16}}) {
    Grains g = packed(300, 0.2, 1, random);
    for (std::size_t b = 0; b < g.count(); ++b)
      g.v_x[b] = random.uniform(-60, 60), g.v_z[b] = random.uniform(-60, 60);
    ContactDetection detection;
    const auto& pairs = detection.find(g.bodies, g.v_x, g.v_z, {walls, still, time_step, margin, period});
    int needed = 0;
    for (int i = 0; i < 300; ++i)
      for (int j = -3; j < 0; ++j) {
        double n_x = 0, n_z = 0;
        const double gap = gap_now({i, j, 0, 0, 0, 0, 0}, g.bodies, walls, period, n_x, n_z);
        if (gap >= margin + 2 * time_step * std::max(0.0, -(n_x * g.v_x[i] + n_z * g.v_z[i]))) continue;
        ++needed;
        EXPECT_EQ(std::count_if(pairs.begin(), pairs.end(),
                                [&](const Candidate& c) { return c.i == i && c.j == j; }),
                  1)
            << i << ' ' << j << " gap " << gap;
      }
    EXPECT_GT(needed, 30);
  }
}

TEST(Detection, GivesTheSameBytesForAnyNumberOfThreads) {
  RandomStream random(12, "test");
  const Grains g = test::falling(6000, random);
  ContactDetection alone, shared;
  ThreadPool pool(2);
  shared.use(&pool);
  const auto one = found(alone, g), two = found(shared, g);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t p = 0; p < one.size(); ++p) {
    EXPECT_EQ(one[p].i, two[p].i);
    EXPECT_EQ(one[p].j, two[p].j);
    EXPECT_EQ(one[p].gap, two[p].gap);
    EXPECT_EQ(one[p].n_x, two[p].n_x);
  }
}

/// The pairs that a search around one collided grain adds, from all pairs: bounds as before it.
std::set<std::pair<int, int>> around(int collided, double displacement, const Grains& g, const Period& period,
                                     const ContactDetection& before) {
  std::set<std::pair<int, int>> pairs;
  for (int k = 0; k < static_cast<int>(g.count()); ++k) {
    if (k == collided) continue;
    const int i = std::min(k, collided), j = std::max(k, collided);
    double n_x = 0, n_z = 0;
    const double gap = gap_now({i, j, 0, 0, 0, 0, 0}, g.bodies, {}, period, n_x, n_z);
    const double approach = -(n_x * (g.v_x[i] - g.v_x[j]) + n_z * (g.v_z[i] - g.v_z[j]));
    if (gap < 2 * margin + 2 * time_step * std::max(0.0, approach) + displacement / 2 +
                  before.displacement_bound(k))
      pairs.insert({i, j});
  }
  return pairs;
}

TEST(Detection, AddsThePairsThatAStruckGrainMayMeet) {
  RandomStream random(14, "test");
  for (const Period& period : {Period{}, Period{-1, 40}})
    for (const double speed : {2.0, 30.0}) {
      Grains g = packed(1500, 1, 1, random);
      ContactDetection detection;
      std::set<std::pair<int, int>> expected;
      for (const Candidate& pair : found(detection, g, period)) expected.insert({pair.i, pair.j});
      const std::size_t known = expected.size();
      const int collided = 700;
      g.v_x[collided] += speed, g.v_z[collided] -= speed;
      const double displacement = 2 * time_step * speed * std::sqrt(2.0);
      expected.merge(around(collided, displacement, g, period, detection));
      const DetectionInput input{{}, {}, time_step, margin, period};
      const CollidedDisc one[] = {{collided, displacement}};
      EXPECT_TRUE(detection.find_around(one, g.bodies, g.v_x, g.v_z, input));
      EXPECT_GT(expected.size(), known);
      auto next = expected.begin();
      ASSERT_EQ(detection.candidates().size(), expected.size());
      for (const Candidate& pair : detection.candidates()) ASSERT_EQ(std::pair(pair.i, pair.j), *next++);
      EXPECT_FALSE(detection.find_around(one, g.bodies, g.v_x, g.v_z, input));  // all are known by now
    }
}

TEST(Detection, BeginsAnewWhereMostAreStruck) {
  RandomStream random(15, "test");
  Grains g = packed(900, 1, 1, random);
  ContactDetection detection;
  (void)found(detection, g);
  std::vector<CollidedDisc> collided;
  for (int i = 0; i < 900; ++i) {
    g.v_x[i] += random.uniform(-20, 20);
    collided.push_back({i, 2.0});
  }
  const DetectionInput input{{}, {}, time_step, margin, {}};
  EXPECT_TRUE(detection.find_around(collided, g.bodies, g.v_x, g.v_z, input));
  EXPECT_EQ(detection.candidates().size(), defined(g, {}).size());
}

/// Distances measured per grain.
template <class Make>
double price(Make make, int count) {
  RandomStream random(13, "test");
  const Grains g = make(count, random);
  ContactDetection detection;
  (void)found(detection, g);
  return static_cast<double>(detection.distances()) / static_cast<double>(g.count());
}

TEST(Detection, MeasuresAsManyDistancesPerGrainWhateverTheirNumber) {
  // Cells of 1.3 d hold 1.7 grains, and half of nine are looked at: some 8 per grain.
  const struct {
    Grains (*make)(int, RandomStream&);
    double most;
  } kinds[] = {{test::flowing, 12},  {test::all_fall, 12}, {test::with_stray, 12},
               {test::scattered, 6}, {test::unlike, 30},   {test::falling, HUGE_VAL}};
  for (const auto& [make, most] : kinds) {
    const double large = price(make, 8000);
    EXPECT_LT(large, most);
    EXPECT_LT(large, 1.2 * price(make, 2000));
  }
}

}  // namespace
}  // namespace drumlin::detection
