#include "continuum/model/touch_down.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "continuum/model/part_line.hpp"
#include "continuum/model/plane_vector.hpp"
#include "continuum/model/region_mesh.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin {
using namespace continuum;
namespace touch_down_tests {
namespace {

constexpr double pi = std::numbers::pi;

double one(Vec2) { return 1; }

RegionPart wall(Vec2 from, Vec2 to) { return {.name = "wall", .curve = SegmentCurve{from, to}}; }
RegionPart opening(Vec2 from, Vec2 to) {
  return {.name = "outlet", .curve = SegmentCurve{from, to}, .kind = RegionPart::Kind::opening};
}

// The material on walls, and its free surface: the wet corners, then free points from the contact at the last
// one on; anticlockwise.
struct Case {
  const char* name;
  std::vector<RegionPart> parts;
  std::vector<Vec2> wet;
  std::vector<Vec2> free;  // without the contacts; long sides are divided
  Vec2 contact;            // where the last of `wet` goes
  double kept;             // the area is kept to this share
};

// Turned, and with left and right changed.
struct View {
  double angle;
  bool mirrored;
  Vec2 operator()(Vec2 p) const {
    if (mirrored) p.x = -p.x;
    return {std::cos(angle) * p.x - std::sin(angle) * p.z, std::sin(angle) * p.x + std::cos(angle) * p.z};
  }
};

Region region_of(const Case& c, const View& view) {
  Region region{c.parts, c.wet};
  for (RegionPart& part : region.parts) {
    auto& curve = std::get<SegmentCurve>(part.curve);
    curve = {view(curve.from), view(curve.to)};
  }
  std::vector<Vec2> free = c.free;
  free.push_back(c.wet[0]);
  for (std::size_t i = 0; i + 1 < free.size(); ++i)
    for (double k = 0, n = std::ceil(length(free[i + 1] - free[i]) / 2.5); k < n; ++k)
      region.fill.push_back(free[i] + k / n * (free[i + 1] - free[i]));
  for (Vec2& point : region.fill) point = view(point);
  if (view.mirrored) std::ranges::reverse(region.fill);
  return region;
}

Outline fill_of(const Region& region) {
  return relabelled({region.fill, std::vector<int>(region.fill.size(), Outline::free)}, region, 0);
}

const RegionPart floor_of_40 = wall({0, 0}, {40, 0});
const std::vector<Case> cases = {
    {"stands", {floor_of_40}, {{2, 0}, {12, 0}}, {{12, 1}, {12, 5}, {2, 5}}, {12, 0}, 1e-14},
    {"rolls over", {floor_of_40}, {{2, 0}, {12, 0}}, {{12.8, 0.4}, {12, 2}, {2, 5}}, {12.8, 0}, 1e-14},
    {"has rolled over", {floor_of_40}, {{2, 0}, {12, 0}}, {{12.8, -0.1}, {12, 2}, {2, 5}}, {12.8, 0}, 1e-14},
    {"closes air in",
     {floor_of_40},
     {{2, 0}, {12, 0}},
     {{12.3, 0.8}, {13, 0.9}, {13.5, 0}, {13, 3}, {2, 5}},
     {13.5, 0},
     0.03},
    {"rolls over twice",
     {floor_of_40},
     {{2, 0}, {12, 0}},
     {{12.8, 0.1}, {13.8, 0.3}, {13.5, 2}, {2, 5}},
     {13.605, 0},
     1e-14},
    {"goes round a corner",
     {floor_of_40, wall({13, 0}, {13, 20})},
     {{2, 0}, {12.5, 0}},
     {{13.3, 0.4}, {12, 1.5}, {2, 5}},
     {13, 0.65},
     1e-14},
    {"comes to a wall",
     {floor_of_40, wall({13, 20}, {13, 0})},
     {{2, 0}, {12.6, 0}},
     {{13.05, 1}, {12, 1.5}, {2, 5}},
     {13, 1},
     0.02},
    {"slides down a wall",
     {wall({0, 0}, {13, 0}), wall({13, 0}, {13, 20})},
     {{0, 0}, {13, 0}, {13, 8}},
     {{12.99, 7}, {12, 6}, {0, 5}},
     {13, 7.02},
     1e-14},
    {"hangs on a wall",
     {wall({0, 0}, {13, 0}), wall({13, 0}, {13, 20})},
     {{0, 0}, {13, 0}, {13, 8}},
     {{12.9, 7}, {12, 6}, {0, 5}},
     {13, 8},
     1e-14},
    {"stays at an edge",
     {wall({0, 0}, {13, 0}), wall({13, 0}, {13, -20})},
     {{0, 0}, {13, 0}},
     {{13.9, 0.2}, {13, 2}, {0, 5}},
     {13, 0},
     1e-14},
    {"stays at an outlet",
     {wall({0, 0}, {13, 0}), opening({13, 0}, {17, 0})},
     {{0, 0}, {13, 0}},
     {{13.9, 0.2}, {13, 2}, {0, 5}},
     {13, 0},
     1e-14},
    {"bends down over an edge",
     {wall({0, 0}, {13, 0}), wall({13, -20}, {13, 0})},
     {{0, 0}, {13, 0}},
     {{13.3, -0.8}, {14, 0.2}, {0, 5}},
     {13, -0.86},
     1e-14},
};

// The contact that belonged to the last wet corner.
Vec2 contact_of(const Outline& outline, bool mirrored) {
  const std::size_t n = outline.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const bool before = outline.part[(i + n - 1) % n] == Outline::free,
               after = outline.part[i] == Outline::free;
    if (mirrored ? before && !after : after && !before) return outline.points[i];
  }
  return {NAN, NAN};
}

TEST(TouchDown, IsTheSameForFloorsSlopesAndWallsFromBothSides) {
  for (const Case& c : cases)
    for (const View view : {View{0, false}, {0, true}, {0.6, false}, {pi / 2, false}, {2.5, true}}) {
      SCOPED_TRACE(testing::Message()
                   << c.name << ", turned by " << view.angle << (view.mirrored ? ", mirrored" : ""));
      const Region region = region_of(c, view);
      const Outline before = fill_of(region);
      const LaidDown laid = laid_down(before, region, 0, one);
      EXPECT_NEAR(length(contact_of(laid.outlines.front(), view.mirrored) - view(c.contact)), 0, 1e-9);
      EXPECT_NEAR(area(laid.outlines.front()), area(before), c.kept * area(before));
      EXPECT_EQ(laid.passed, 0);
      const Outline fine = resampled(laid.outlines.front(), region, 0, one);
      const Outline whole = with_area(fine, region, 0, area(before));
      EXPECT_NEAR(area(whole), area(before), 1e-12 * area(before));
      EXPECT_GT(quality(mesh_of(whole, one)), 0.02);
    }
}

TEST(TouchDown, FollowsADrum) {
  const Region drum{{{.name = "drum", .curve = CircleCurve{{0, 0}, 10}}}, {}};
  Outline outline;
  for (int degrees = 200; degrees <= 340; degrees += 5) {
    outline.points.push_back(PartLine{{0, 0}, {}, 20 * pi, 10}.at(10 * degrees * pi / 180));
    outline.part.push_back(degrees < 340 ? 0 : Outline::free);
  }
  outline.points.insert(outline.points.end(), {{9.9, -2.7}, {8, -1.5}, {5, -2}, {0, -3}});
  outline.part.resize(outline.points.size(), Outline::free);
  const Outline laid = laid_down(outline, drum, 0, one).outlines.front();
  const Vec2 contact = contact_of(laid, false);
  EXPECT_NEAR(length(contact), 10, 1e-12);
  EXPECT_GT(contact.z, -2.8);
  EXPECT_NEAR(area(laid), area(outline), 0.01 * area(outline));
  const Outline whole = with_area(resampled(laid, drum, 0, one), drum, 0, area(outline));
  EXPECT_GT(quality(mesh_of(whole, one)), 0.1);
}

TEST(TouchDown, CutsOffWhatHasPassedAnOpening) {
  const Region chute{{wall({0, 0}, {13, 0}), opening({13, 0}, {13, 9})},
                     {{0, 0}, {12.5, 0}, {13.4, 0.8}, {13.2, 1.5}, {12.8, 2.5}, {0, 4}}};
  const Outline before = fill_of(chute);
  const LaidDown laid = laid_down(before, chute, 0, one);
  EXPECT_NEAR(contact_of(laid.outlines.front(), false).x, 13, 1e-12);
  EXPECT_NEAR(contact_of(laid.outlines.front(), false).z, 2, 1e-12);
  EXPECT_NEAR(laid.passed, 0.5 * (0.4 * (1.5 - 4 / 9.0) + 0.2 * (2 - 0.8)), 1e-12);
  EXPECT_NEAR(area(laid.outlines.front()), area(before) - laid.passed + 0.5 * 0.5 * 4 / 9,
              1e-12);  // the corner is closed

  // Above the corner first: air is left below.
  const Region fall{chute.parts, {{0, 0}, {8, 0}, {9, 2}, {11, 3}, {13.2, 4}, {13.2, 5}, {11, 6}, {0, 7}}};
  const LaidDown over = laid_down(fill_of(fall), fall, 0, one);
  EXPECT_NEAR(over.passed, area(fill_of(fall)) - area(over.outlines.front()), 1e-12);
  EXPECT_NEAR(over.passed, 0.2 * (1 + 0.2 / 2.2), 1e-12);
  EXPECT_EQ(contact_of(over.outlines.front(), false).x, 8);
}

TEST(TouchDown, LetsAColumnSpreadIntoACorner) {
  const Region region{{wall({0, 30}, {0, 0}), wall({0, 0}, {16, 0}), wall({16, 0}, {16, 30})},
                      {{0, 0}, {10, 0}, {10, 10}, {0, 10}}};
  Outline outline = outline_of(region, 0, one);
  for (int step = 0; step < 60; ++step) {
    const std::size_t n = outline.points.size();
    for (std::size_t i = 0; i < n; ++i)
      if (Vec2& p = outline.points[i];
          outline.part[i] == Outline::free && outline.part[(i + n - 1) % n] == Outline::free)
        p = p + 0.03 * Vec2{p.x * std::tanh(p.z) * (1 - p.x / 16.3), -p.z};
    const LaidDown laid = laid_down(relabelled(outline, region, 0), region, 0, one);
    outline = with_area(resampled(laid.outlines.front(), region, 0, one), region, 0, 100);
    ASSERT_NEAR(area(outline), 100, 1e-10);
    ASSERT_GT(quality(mesh_of(outline, one)), 0.05);
  }
  EXPECT_EQ(contact_of(outline, false).x, 16);
}

const std::vector<RegionPart> box_of_40 = {floor_of_40, wall({40, 0}, {40, 40})};

TEST(TouchDown, RefusesToCloseMuchAir) {
  const Region region{box_of_40, {{2, 0}, {12, 0}, {12, 9}, {25, 12}, {28, -0.1}, {30, 12}, {2, 20}}};
  EXPECT_THROW(laid_down(fill_of(region), region, 0, one), NotConvergedError);  // a jet far from the contact
}

double area_of(const LaidDown& laid) {
  double sum = 0;
  for (const Outline& outline : laid.outlines) {
    EXPECT_FALSE(crossing_of(outline));
    sum += area(outline);
  }
  return sum;
}

TEST(TouchDown, BreaksWhereTheSurfaceComesToTheWetFloor) {
  const Region region{box_of_40, {{2, 0}, {30, 0}, {30, 4}, {20, -0.1}, {12, 4}, {2, 5}}};
  const Outline before = fill_of(region);
  const LaidDown laid = laid_down(before, region, 0, one);
  EXPECT_EQ(laid.outlines.size(), 2u);
  EXPECT_NEAR(area_of(laid), area(before), 0.05);
  EXPECT_EQ(laid.passed, 0);
}

// A funnel, its bottom a tenth above the slot or just beyond it; what lies between has passed.
TEST(TouchDown, BreaksWhereTheSurfaceComesToAnOpening) {
  const std::vector<RegionPart> parts = {wall({0, 0}, {15, 0}), wall({25, 0}, {40, 0}),
                                         opening({15, 0}, {25, 0}), wall({0, 0}, {0, 20}),
                                         wall({40, 0}, {40, 20})};
  for (const double height : {0.1, -0.05}) {
    const Region region{parts, {{0, 0}, {40, 0}, {40, 12}, {21, 2}, {20.2, height}, {19, 2}, {0, 12}}};
    const Outline before = fill_of(region);
    const LaidDown laid = laid_down(before, region, 0, one);
    ASSERT_EQ(laid.outlines.size(), 2u);
    EXPECT_NEAR(area_of(laid) + laid.passed, area(before), 1e-12);
    EXPECT_LT(std::abs(laid.passed), 0.3);
    for (const Outline& outline : laid.outlines) {
      const Outline fine = with_area(resampled(outline, region, 0, one), region, 0, area(outline));
      EXPECT_GT(quality(mesh_of(fine, one)), 0.1);
      EXPECT_EQ(std::ranges::count(outline.part, 2), 1);
    }
    EXPECT_EQ(outlines_of(mesh_of(laid.outlines, one)).size(), 2u);
  }
}

// A tongue that has come down into the surface before it, with a little air.
TEST(TouchDown, ClosesTheAirUnderASurfaceThatFoldsOntoItself) {
  const Region region{
      box_of_40,
      {{2, 0}, {40, 0}, {40, 4}, {20, 4}, {19, 5}, {21, 5.5}, {21.5, 3.8}, {22.5, 6.5}, {12, 9}, {2, 9}}};
  const Outline before = fill_of(region);
  const LaidDown laid = laid_down(before, region, 0, one);
  ASSERT_EQ(laid.outlines.size(), 1u);
  EXPECT_NEAR(area_of(laid), area(before), 3);
  EXPECT_GT(area_of(laid), area(before));
}

TEST(TouchDown, ClosesASharpNotchAndCutsOffASharpTip) {
  const Region floor{{wall({-1, 0}, {21, 0}), wall({0, -1}, {0, 20}), wall({20, -1}, {20, 20})}, {}};
  Outline outline{{{0, 0}, {20, 0}, {20, 10}, {10.5, 10}, {10, 5}, {9.5, 10}, {0, 10}},
                  {0, 2, -1, -1, -1, -1, 1}};
  const auto points_at = [&](double z) {
    outline.points[4] = {10, z};
    return laid_down(outline, floor, 0, one).outlines.front().points.size();
  };
  EXPECT_EQ(points_at(7.5), 6u);    // 22.6 degrees
  EXPECT_EQ(points_at(9), 7u);      // 53 degrees
  EXPECT_EQ(points_at(11), 6u);     // a tip of 53 degrees
  EXPECT_EQ(points_at(10.75), 7u);  // of 67 degrees
  EXPECT_EQ(points_at(12.2), 7u);   // one of more than a cell
}

}  // namespace
}  // namespace touch_down_tests
}  // namespace drumlin
