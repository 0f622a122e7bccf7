#include "continuum/model/region_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/core/basics/errors.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin::region_problem_test {
using namespace continuum;
namespace {

// d = 2 mm, sqrt(d/g) = 14.3 ms.
FlowScene scene(const std::vector<std::string>& overrides = {}) {
  return read_flow_scene(test::data_folder().parent_path() / "tests/scene/every_key_region.toml", overrides);
}
RheologyFit law() {
  RheologyFit law;
  law.mu = JopLaw{.mu_s = 0.32, .mu_2 = 0.6, .I_0 = 0.4};
  law.nu = 0.8;
  return law;
}
constexpr double unit_s = 0.0142784;

void expect_near(const Vec2& got, double x, double z) {
  EXPECT_NEAR(got.x, x, 1e-12);
  EXPECT_NEAR(got.z, z, 1e-12);
}

TEST(RegionProblem, HasTheSceneInTheUnitsOfItsGrains) {
  const Region region = region_of(scene());
  ASSERT_EQ(region.parts.size(), 4U);
  const RegionPart &drum = region.parts[0], &plane = region.parts[1], &gate = region.parts[2],
                   &slot = region.parts[3];
  const auto& circle = std::get<CircleCurve>(drum.curve);
  expect_near(circle.center, 1.5, 2);
  EXPECT_NEAR(circle.radius, 50, 1e-12);
  EXPECT_NEAR(drum.rotation, -0.1 * std::numbers::pi * unit_s, 1e-7);
  EXPECT_EQ(drum.kind, RegionPart::Kind::friction);
  EXPECT_EQ(drum.friction, 0.4);
  EXPECT_NEAR(drum.begins, 0.1 / unit_s, 1e-3);
  EXPECT_EQ(plane.kind, RegionPart::Kind::rough);
  EXPECT_TRUE(std::isinf(plane.ends));
  EXPECT_EQ(gate.kind, RegionPart::Kind::friction);  // smooth
  EXPECT_EQ(gate.friction, 0);
  EXPECT_NEAR(gate.velocity.z, 15 * unit_s, 1e-6);
  EXPECT_NEAR(gate.ends, 0.2 / unit_s, 1e-3);
  EXPECT_EQ(slot.kind, RegionPart::Kind::opening);
  expect_near(std::get<SegmentCurve>(slot.curve).to, 15, 0);
  expect_near(region.fill.at(2), 20, 34);
}

TEST(RegionProblem, HasItsLawItsTimesAndItsGrid) {
  const RegionFlow flow = region_flow(scene(), law());
  EXPECT_EQ(flow.nu, 0.8);
  EXPECT_EQ(std::get<JopLaw>(flow.law).mu_s, 0.32);
  EXPECT_NEAR(flow.gravity.x, std::cos(80 * std::numbers::pi / 180), 1e-15);
  EXPECT_NEAR(flow.gravity.z, -std::sin(80 * std::numbers::pi / 180), 1e-15);
  ASSERT_EQ(flow.frames.size(), 3U);
  EXPECT_NEAR(flow.frames[1], 0.1 / unit_s, 1e-3);
  EXPECT_EQ(flow.frames[2], flow.end);
  EXPECT_NEAR(flow.x.from, -10, 1e-12);
  EXPECT_NEAR(flow.z.to, 40, 1e-12);
  EXPECT_EQ(region_flow(scene({"time={end_s=0.5, step_s=1e-3, frames_every_s=0.1}"}), law()).frames.size(),
            6U);
}

// The circle reaches from -97 mm on.
TEST(RegionProblem, TakesTheWholeRegionForItsGridWhereNoneIsGiven) {
  const RegionFlow flow = region_flow(scene({"output={}"}), law());
  EXPECT_NEAR(flow.x.from, -48.5, 1e-12);
  EXPECT_NEAR(flow.z.to, 52, 1e-12);
}

TEST(RegionProblem, RefusesALawWithK) {
  RheologyFit with_k = law();
  with_k.k = NormalStressRatio{.I = {1e-3, 1e-1}, .k = {0.95, 1}};
  EXPECT_THROW((void)region_flow(scene(), with_k), InputError);
}

}  // namespace
}  // namespace drumlin::region_problem_test
