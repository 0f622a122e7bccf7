#include "continuum/model/drum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/exchange/errors.hpp"

namespace drumlin {
namespace {

FlowScene paper_scene() { return read_flow_scene(DRUMLIN_DATA "/scenes/drum-6rpm-flow.toml"); }

TEST(DrumGeometry, GrainsCoverTheFlowDomainAtTheLawsVolumeFraction) {
  const FlowScene scene = paper_scene();
  const DrumGeometry drum = drum_geometry(scene, 0.82);
  EXPECT_NEAR(drum.radius, 225 / 3.3, 1e-9);
  EXPECT_NEAR(drum.rotation, 0.0115, 5e-5);
  EXPECT_NEAR(drum.axis_offset, 3, 0.1);  // "at nu = 0.82 the surface lies 3 d below the axis"
  EXPECT_NEAR(0.82 * segment_area(drum.radius, drum.axis_offset),
              grain_area(scene.grains, *scene.grains.count), 1e-6);
}

TEST(DrumGeometry, AHalfFullDrumHasItsSurfaceAtTheAxis) {
  const double R = 10;
  EXPECT_NEAR(chord_offset(R, 0.5 * std::numbers::pi * R * R), 0, 1e-12);
  EXPECT_LT(chord_offset(R, 0.7 * std::numbers::pi * R * R), 0);
}

TEST(DrumGeometry, RefusesMoreGrainsThanFit) { EXPECT_THROW(drum_geometry(paper_scene(), 0.3), InputError); }

TEST(DrumProblem, WallTurnsRigidlyAndRestsAtTheEndsOfTheSurface) {
  const DrumGeometry drum = drum_geometry(paper_scene(), 0.82);
  const FlowProblem problem = drum_problem(paper_scene(), drum, LogLaw{0.35, 0.013});
  const auto& wall = std::get<PrescribedVelocity>(problem.boundary.at(Side::bottom));
  const Vec2 lowest = wall.velocity({0, drum.axis_offset - drum.radius});
  EXPECT_NEAR(lowest.x, -drum.rotation * drum.radius, 1e-12);  // against the surface flow
  EXPECT_NEAR(lowest.z, 0, 1e-12);
  const Vec2 corner = wall.velocity({drum.half_chord(), 0});
  EXPECT_NEAR(std::hypot(corner.x, corner.z), 0, 1e-12);
}

TEST(DrumProblem, SlopeIsFoundUnlessPrescribed) {
  FlowScene scene = paper_scene();
  EXPECT_TRUE(std::holds_alternative<SlopeFromMoment>(
      drum_problem(scene, drum_geometry(scene, 0.82), LogLaw{0.35, 0.013}).slope));
  std::get<FlowDrum>(scene.geometry).slope_deg = 23;
  const FlowProblem steep = drum_problem(scene, drum_geometry(scene, 0.82), LogLaw{0.35, 0.013});
  EXPECT_NEAR(std::get<FixedSlope>(steep.slope).theta, 23 * std::numbers::pi / 180, 1e-15);
  EXPECT_TRUE(no_steady_state(steep));
}

TEST(NoSteadyState, IsSaidOfASlopeThatTheLawCannotCarry) {
  FlowProblem problem;
  problem.law = LogLaw{0.35, 0.013};
  problem.slope = FixedSlope{18 * std::numbers::pi / 180};
  EXPECT_FALSE(no_steady_state(problem));
  problem.slope = FixedSlope{23 * std::numbers::pi / 180};  // tan = 0.424, the law gives 0.380 at I = 10
  EXPECT_TRUE(no_steady_state(problem));
  problem.slope = SlopeFromMoment{};
  EXPECT_FALSE(no_steady_state(problem));
}

}  // namespace
}  // namespace drumlin
