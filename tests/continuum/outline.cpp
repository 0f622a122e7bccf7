#include "continuum/model/outline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "continuum/model/plane_vector.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin {
using namespace continuum;
namespace outline_tests {
namespace {

constexpr double pi = std::numbers::pi;

SizeField equal(double size) {
  return [=](Vec2) { return size; };
}

RegionPart wall(Vec2 from, Vec2 to) { return {.name = "wall", .curve = SegmentCurve{from, to}}; }
RegionPart opening(Vec2 from, Vec2 to, double begins) {
  return {
      .name = "slot", .curve = SegmentCurve{from, to}, .kind = RegionPart::Kind::opening, .begins = begins};
}
RegionPart circle(double radius) { return {.name = "drum", .curve = CircleCurve{{0, 0}, radius}}; }

// A box of 20 by 30 with a slot from 8 to 12 in its floor, filled up to 10.
Region box_with_slot() {
  return {
      {wall({0, 30}, {0, 0}), wall({0, 0}, {20, 0}), wall({20, 0}, {20, 30}), opening({8, 0}, {12, 0}, 1)},
      {{0, 0}, {20, 0}, {20, 10}, {0, 10}}};
}

// A disc of radius 10, filled up to this angle from the lowest point, by chords of 5 deg.
Region filled_drum(double half_angle) {
  Region drum{{circle(10)}, {}};
  const int chords = static_cast<int>(std::round(2 * half_angle / (pi / 36)));
  for (int i = 0; i <= chords; ++i) {
    const double angle = -pi / 2 - half_angle + 2 * half_angle * i / chords;
    drum.fill.push_back({10 * std::cos(angle), 10 * std::sin(angle)});
  }
  return drum;
}

double length_on(const Outline& outline, int part) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.points.size(); ++i)
    if (outline.part[i] == part)
      sum += length(outline.points[(i + 1) % outline.points.size()] - outline.points[i]);
  return sum;
}

TEST(Outline, OfABoxWithASlotIsCutWhereTheSlotBegins) {
  for (const double time : {0.0, 2.0}) {  // closed, open
    const Outline outline = outline_of(box_with_slot(), time, equal(1));
    EXPECT_EQ(outline.points.size(), 60);
    EXPECT_NEAR(area(outline), 200, 1e-12);
    EXPECT_NEAR(length_on(outline, 0), 10, 1e-12);
    EXPECT_NEAR(length_on(outline, 1), 16, 1e-12);
    EXPECT_NEAR(length_on(outline, 2), 10, 1e-12);
    EXPECT_NEAR(length_on(outline, 3), 4, 1e-12);
    EXPECT_NEAR(length_on(outline, Outline::free), 20, 1e-12);
  }
}

TEST(Outline, IsFreeWhereAGateIsGoneOrHasRisen) {
  Region region{{wall({0, 0}, {60, 0}), wall({10, 0}, {10, 30})}, {{0, 0}, {10, 0}, {10, 20}, {0, 20}}};
  region.parts[1].velocity = {0, 2};
  region.parts[1].ends = 4;
  Outline outline = outline_of(region, 0, equal(1));
  for (const auto& [time, wet] : {std::pair{0.0, 20.0}, {1.25, 17.5}, {3.0, 14.0}, {4.0, 0.0}}) {
    outline = relabelled(outline, region, time);
    EXPECT_NEAR(length_on(outline, 1), wet, 1e-12);
    EXPECT_NEAR(length_on(outline, Outline::free), 60 - 10 - wet, 1e-12);
    outline = resampled(outline, region, time, equal(1));
    EXPECT_NEAR(area(outline), 200, 1e-10);
  }
}

TEST(Outline, OfADrumIsOfChords) {
  for (const double half_angle : {pi / 6, pi / 2, 0.8 * pi}) {
    const Region drum = filled_drum(half_angle);
    const Outline outline = outline_of(drum, 0, equal(0.5));
    for (std::size_t i = 0; i < outline.points.size(); ++i)
      EXPECT_TRUE(outline.part[i] != 0 || std::abs(length(outline.points[i]) - 10) < 1e-12);
    EXPECT_NEAR(length_on(outline, 0), 20 * half_angle, 1e-3 * 20 * half_angle);
    EXPECT_NEAR(length_on(outline, Outline::free), 20 * std::sin(half_angle), 1e-12);
  }
}

TEST(Outline, FollowsASizeThatGrows) {
  const auto size = [](Vec2 p) { return 0.25 + 0.2 * std::abs(p.x - 10); };
  const Outline outline = outline_of(box_with_slot(), 0, size);
  for (std::size_t i = 0; i < outline.points.size(); ++i) {
    const Vec2 a = outline.points[i], b = outline.points[(i + 1) % outline.points.size()];
    EXPECT_TRUE(outline.part[i] != 1 || std::abs(length(b - a) / size(0.5 * (a + b)) - 1) < 0.1);
  }
}

TEST(Outline, KeepsItsFreePointsAtMoreThanHalfAndLessThanOneAndAHalfSizes) {
  Outline outline = outline_of(box_with_slot(), 0, equal(1));
  for (Vec2& point : outline.points)
    if (point.z > 9 && point.x > 0 && point.x < 20) point.z += 4 * std::sin(pi * point.x * point.x / 400);
  const double before = area(outline);
  const Outline once = resampled(outline, box_with_slot(), 0, equal(0.4));
  const Outline twice = resampled(once, box_with_slot(), 0, equal(2));
  EXPECT_NEAR(area(once), before, 1e-3 * before);
  EXPECT_NEAR(area(twice), area(once), 1e-12 * before);  // short sides are merged with the area kept
  for (const auto& [fresh, size] : {std::pair{once, 0.4}, {twice, 2.0}})
    for (std::size_t i = 0; i < fresh.points.size(); ++i)
      if (fresh.part[i] == Outline::free) {
        const double side = length(fresh.points[(i + 1) % fresh.points.size()] - fresh.points[i]);
        EXPECT_GE(side, 0.5 * size);
        EXPECT_LE(side, 1.5 * size);
      }
}

TEST(Outline, IsGivenAnAreaByItsFreePoints) {
  for (const Region& region : {box_with_slot(), filled_drum(1.2)}) {
    const Outline outline = outline_of(region, 0, equal(0.7));
    for (const double share : {0.97, 0.999, 1.0, 1.03}) {
      const Outline moved = with_area(outline, region, 0, share * area(outline));
      EXPECT_NEAR(area(moved), share * area(outline), 1e-12 * area(outline));
      EXPECT_EQ(moved.part, outline.part);
      EXPECT_FALSE(crossing_of(moved));
    }
  }
  // The surface of a box stays level: its contacts go with it.
  const Region box = box_with_slot();
  const Outline raised = with_area(outline_of(box, 0, equal(1)), box, 0, 206);
  for (std::size_t i = 0; i < raised.points.size(); ++i)
    EXPECT_TRUE(raised.part[i] != Outline::free || std::abs(raised.points[i].z - 10.3) < 1e-12);
}

TEST(Outline, TellsWhereItCrossesItself) {
  const auto crossing = [](std::vector<Vec2> points) {
    const std::vector<int> part(points.size(), Outline::free);
    return crossing_of({std::move(points), part}).has_value();
  };
  EXPECT_FALSE(crossing({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}}));
  EXPECT_FALSE(crossing({{0, 0}, {1, 0}, {2, 0}, {2, 1}}));
  EXPECT_TRUE(crossing({{0, 0}, {4, 0}, {4, 4}, {2, -1}, {0, 4}}));
  EXPECT_TRUE(crossing({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}));  // touches
  EXPECT_TRUE(crossing({{0, 0}, {4, 0}, {2, 0}, {2, 4}}));          // turns back
  EXPECT_TRUE(crossing({{0, 0}, {4, 0}, {4, 0}, {2, 4}}));          // no length
}

}  // namespace
}  // namespace outline_tests
}  // namespace drumlin
