// Lists of near pairs that later searches use again: they find what a search from nothing finds, byte for
// byte.
#include <gtest/gtest.h>

#include <cmath>

#include "particles/detection/contact_list.hpp"
#include "particles/scene/random.hpp"
#include "tests/particles/many_grains.hpp"

namespace drumlin::kept_lists {
namespace {

using namespace particles;
using namespace test;

constexpr double margin = 0.02;

void move(test::Grains& g, double time_step) {
  for (std::size_t b = 0; b < g.count(); ++b) {
    g.bodies.x[b] += time_step * g.v_x[b];
    g.bodies.z[b] += time_step * g.v_z[b];
  }
}

void expect_same(const ContactDetection& reused, const ContactDetection& anew, std::size_t bodies) {
  ASSERT_EQ(reused.candidates().size(), anew.candidates().size());
  for (std::size_t p = 0; p < reused.candidates().size(); ++p) {
    const Candidate &a = reused.candidates()[p], &b = anew.candidates()[p];
    ASSERT_EQ(std::pair(a.i, a.j), std::pair(b.i, b.j));
    ASSERT_EQ(a.gap, b.gap);
    ASSERT_EQ(std::pair(a.n_x, a.n_z), std::pair(b.n_x, b.n_z));
    ASSERT_EQ(std::pair(a.wall_v_x, a.wall_v_z), std::pair(b.wall_v_x, b.wall_v_z));
  }
  for (std::size_t b = 0; b < bodies; ++b)
    ASSERT_EQ(reused.displacement_bound(static_cast<std::int32_t>(b)),
              anew.displacement_bound(static_cast<std::int32_t>(b)));
}

struct Case {
  const char* name;
  test::Grains grains;
  double time_step;
  Period period;
  bool used_again;  // whether a list ought to be
};

std::vector<Case> cases() {
  RandomStream random(21, "test");
  std::vector<Case> all;
  all.push_back({"at rest", packed(900, 1, 0, random), 0.05, {}, true});
  all.push_back({"flowing", flowing(900, random), 0.01, {}, true});
  all.push_back({"turning", packed(900, 0.8, 0.05, random), 0.05, {}, true});
  test::Grains& turning = all.back().grains;
  for (std::size_t b = 0; b < turning.count(); ++b) {
    turning.v_x[b] += 0.05 * turning.bodies.z[b];
    turning.v_z[b] -= 0.05 * turning.bodies.x[b];
  }
  all.push_back({"one fast grain", packed(900, 1, 0.1, random), 0.02, {}, false});
  all.back().grains.v_x[450] = 60, all.back().grains.v_z[450] = 45;
  all.push_back({"unlike", unlike(700, random), 0.05, {}, false});
  all.push_back({"falling", falling(700, random), 0.05, {}, false});
  all.push_back({"gas", scattered(500, random), 0.05, {}, false});
  all.push_back({"periodic", flowing(700, random), 0.01, Period{-1, 40}, false});
  return all;
}

TEST(KeptLists, FindWhatASearchFromNothingFinds) {
  const std::vector<Shape> walls = {Segment{{-2, -1}, {60, -1}}, FixedDisc{{5, 40}, 4}};
  const std::vector<ShapeStep> still(walls.size());
  ThreadPool pool(2);
  for (Case& c : cases()) {
    SCOPED_TRACE(c.name);
    RandomStream random(22, "test");
    ContactDetection reused;
    reused.use(&pool);
    bool cheap = false;
    for (int step = 0; step < 60; ++step) {
      const DetectionInput input{walls, still, c.time_step, margin, c.period};
      ContactDetection anew;
      anew.find(c.grains.bodies, c.grains.v_x, c.grains.v_z, input);
      reused.find(c.grains.bodies, c.grains.v_x, c.grains.v_z, input);
      expect_same(reused, anew, c.grains.count());
      cheap = cheap || reused.distances() < anew.distances();
      if (step % 3 == 0) {  // an impact impacts two grains
        const auto i =
            static_cast<std::int32_t>(random.uniform() * static_cast<double>(c.grains.count() - 1));
        std::vector<CollidedDisc> collided;
        for (const std::int32_t b : {i, i + 1}) {
          const double v = random.uniform(-3, 3);
          c.grains.v_x[b] += v, c.grains.v_z[b] -= v;
          collided.push_back({b, 2 * c.time_step * std::sqrt(2.0) * std::abs(v)});
        }
        const bool more = anew.find_around(collided, c.grains.bodies, c.grains.v_x, c.grains.v_z, input);
        EXPECT_EQ(reused.find_around(collided, c.grains.bodies, c.grains.v_x, c.grains.v_z, input), more);
        expect_same(reused, anew, c.grains.count());
      }
      move(c.grains, c.time_step);
    }
    EXPECT_TRUE(cheap || !c.used_again);
  }
}

TEST(KeptLists, AreMadeAnewForOtherGrains) {
  // As many bodies, of other radii in other places: what a rank of many sees after grains have moved on.
  RandomStream random(23, "test");
  const DetectionInput input{{}, {}, 0.05, margin, {}};
  ContactDetection reused;
  test::Grains g = packed(400, 0.7, 0.01, random);
  for (int step = 0; step < 5; ++step) reused.find(g.bodies, g.v_x, g.v_z, input);
  const test::Grains other = packed(400, 0.5, 0.3, random);
  ContactDetection anew;
  anew.find(other.bodies, other.v_x, other.v_z, input);
  reused.find(other.bodies, other.v_x, other.v_z, input);
  expect_same(reused, anew, other.count());
  const test::Grains fewer = packed(100, 1, 0.3, random);
  ContactDetection again;
  again.find(fewer.bodies, fewer.v_x, fewer.v_z, input);
  reused.find(fewer.bodies, fewer.v_x, fewer.v_z, input);
  expect_same(reused, again, fewer.count());
}

}  // namespace
}  // namespace drumlin::kept_lists
