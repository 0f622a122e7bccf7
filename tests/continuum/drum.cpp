#include "continuum/model/drum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "tests/support/data_folder.hpp"
#include "tests/support/says.hpp"

namespace drumlin::drum_test {
using namespace continuum;
namespace {

RheologyFit paper_law() {
  RheologyFit law;
  law.mu = LogLaw{.a = 0.35, .b = 0.013};
  law.nu = 0.82;
  return law;
}
FlowScene paper_scene() {
  return read_flow_scene(drumlin::test::data_folder() / "scenes/drum-6rpm-flow.toml");
}

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
  const FlowProblem problem = drum_problem(paper_scene(), paper_law());
  const auto& wall = std::get<PrescribedVelocity>(problem.boundary.at(Side::bottom));
  const Vec2 lowest = wall.velocity({0, drum.axis_offset - drum.radius});
  EXPECT_NEAR(lowest.x, -drum.rotation * drum.radius, 1e-10);  // against the surface flow, behind by e^-25
  EXPECT_NEAR(lowest.z, 0, 1e-12);
  const Vec2 corner = wall.velocity({drum.half_chord(), 0});
  EXPECT_NEAR(std::hypot(corner.x, corner.z), 0, 1e-12);
}

TEST(DrumProblem, SlopeIsFoundUnlessPrescribed) {
  FlowScene scene = paper_scene();
  EXPECT_TRUE(std::holds_alternative<SlopeFromMoment>(drum_problem(scene, paper_law()).slope));
  std::get<FlowDrum>(scene.geometry).slope_deg = 23;
  const FlowProblem steep = drum_problem(scene, paper_law());
  EXPECT_NEAR(std::get<FixedSlope>(steep.slope).theta, 23 * std::numbers::pi / 180, 1e-15);
  EXPECT_TRUE(no_steady_state(steep));
}

// Of a scene with every effect and a law with k.
TEST(DrumProblem, HoldsAllThatTheSceneAndTheLawName) {
  FlowScene scene = paper_scene();
  scene.effects = FlowEffects{.inertia = FlowInertia{},
                              .rotating_frame = FlowRotatingFrame{},
                              .wall_slip = FlowWallSlip{.friction = 0.4, .slip_speed = 2e-4},
                              .memory = {},
                              .nonlocal = FlowNonlocal{.length = 1.5},
                              .moving_surface = FlowMovingSurface{.degree = 12, .tolerance = 0.02}};
  RheologyFit law = paper_law();
  law.k = NormalStressRatio{.I = {1e-3, 1e-2, 1e-1}, .k = {0.95, 1, 1.1}};
  const FlowProblem problem = drum_problem(scene, law);
  EXPECT_EQ(std::get<LogLaw>(problem.law).a, 0.35);
  EXPECT_EQ(std::get<LogLaw>(problem.law).b, 0.013);
  EXPECT_EQ(problem.density, 0.82);
  ASSERT_TRUE(problem.turned);
  EXPECT_DOUBLE_EQ(problem.turned->k.at_ln(std::log(1e-1)).value, 1.1);
  ASSERT_TRUE(problem.nonlocal);
  EXPECT_EQ(problem.nonlocal->length, 1.5);
  EXPECT_TRUE(problem.inertia);
  ASSERT_TRUE(problem.frame);
  EXPECT_EQ(problem.frame->rotation, drum_geometry(scene, 0.82).rotation);
  ASSERT_TRUE(problem.moving_surface);
  EXPECT_EQ(problem.moving_surface->degree, 12);
  EXPECT_EQ(problem.moving_surface->tolerance, 0.02);
  const auto& wall = std::get<FrictionWall>(problem.boundary.at(Side::bottom));
  EXPECT_EQ(wall.friction, 0.4);
  EXPECT_EQ(wall.slip_speed, 2e-4);
}

TEST(DrumProblem, WallTakesTheMaterialAlongOverOneLength) {
  FlowScene scene = paper_scene();
  scene.effects.moving_surface = FlowMovingSurface{};
  const FlowProblem problem = drum_problem(scene, paper_law());
  const DrumGeometry drum = drum_geometry(scene, 0.82);
  const double length = scene.boundary->entrainment_length;
  // At these distances from the right end of a surface that lies where it did, or has gone there.
  for (const double s : {0.0, 1.0, length, 4 * length}) {
    const Vec2 at{drum.half_chord(), 0};
    for (const double height : {0.0, 5.0}) {
      const Vec2 end{at.x, height};
      const Vec2 down{at.x, height - s};
      const Vec2 moving = problem.moving_surface->wall_velocity(down, {-60, 0}, end);
      const Vec2 rigid = rigid_rotation(drum.rotation, drum.axis_offset, down);
      const double share = 1 - std::exp(-s / (length + 0.3 * height));
      EXPECT_NEAR(moving.x, share * rigid.x, 1e-12) << s << ' ' << height;
      EXPECT_NEAR(moving.z, share * rigid.z, 1e-12);
    }
  }
  const auto& wall = std::get<PrescribedVelocity>(problem.boundary.at(Side::bottom)).velocity;
  EXPECT_EQ(wall({drum.half_chord(), 0}).z, 0);
}

TEST(DrumProblem, HoldsNoEffectThatNobodyNames) {
  FlowScene scene = paper_scene();
  scene.effects = {};
  const FlowProblem problem = drum_problem(scene, paper_law());
  EXPECT_FALSE(problem.turned || problem.nonlocal || problem.threshold_fluidity || problem.memory ||
               problem.inertia || problem.frame || problem.moving_surface || problem.extra_force);
}

std::vector<std::string> refused(const FlowScene& scene, const RheologyFit& law) {
  std::vector<std::string> keys;
  try {
    (void)drum_problem(scene, law);
  } catch (const InputError& error) {
    for (const auto& problem : error.problems()) keys.push_back(problem.key);
  }
  return keys;
}

using Keys = std::vector<std::string>;

TEST(DrumProblem, RefusesEffectsThatTheLawDoesNotAllow) {
  FlowScene scene = paper_scene();
  scene.effects = {};
  scene.effects.nonlocal = FlowNonlocal{.length = 1};
  EXPECT_EQ(refused(scene, paper_law()), Keys{});
  RheologyFit law = paper_law();
  law.mu = JopLaw{0.38, 0.64, 0.28};  // a threshold: below it mu does not determine the fluidity
  EXPECT_EQ(refused(scene, law), Keys{"effects.nonlocal"});
  for (const FlowNonlocal& nonlocal :
       {FlowNonlocal{.length = 1}, FlowNonlocal{.amplitude = 0.5, .threshold = 0.3}}) {
    scene.effects.nonlocal = nonlocal;
    RheologyFit cohesive = paper_law();
    cohesive.mu = CohesiveLaw{0.5, 0.3, 1};
    EXPECT_EQ(refused(scene, cohesive), Keys{"effects.nonlocal"});
  }
  // All faults at once; memory brings a mu(I) of its own, which has no threshold.
  scene.effects.memory = FlowMemory{};
  scene.effects.nonlocal = FlowNonlocal{.amplitude = 0.5};
  EXPECT_EQ(refused(scene, law), (Keys{"effects.memory", "effects.nonlocal.threshold"}));
}

TEST(DrumProblem, TakesAThresholdFromTheSceneOrItsLaw) {
  FlowScene scene = paper_scene();
  scene.effects = {};
  scene.effects.nonlocal = FlowNonlocal{.amplitude = 0.5};
  RheologyFit law = paper_law();
  EXPECT_EQ(refused(scene, law), Keys{"effects.nonlocal.threshold"});  // a logarithm creeps at any stress
  law.mu = JopLaw{0.38, 0.64, 0.28};
  EXPECT_EQ(drum_problem(scene, law).threshold_fluidity.value().amplitude, 0.5);
  EXPECT_FALSE(drum_problem(scene, law).threshold_fluidity->threshold);
  EXPECT_FALSE(drum_problem(scene, law).nonlocal);
  scene.effects.nonlocal->threshold = 0.26;
  EXPECT_EQ(drum_problem(scene, paper_law()).threshold_fluidity.value().threshold, 0.26);
  law.k = NormalStressRatio{.I = {1e-3, 1e-1}, .k = {0.95, 1.1}};
  EXPECT_EQ(refused(scene, law), Keys{"effects.nonlocal"});
  scene.effects.nonlocal = FlowNonlocal{};  // neither length nor amplitude
  EXPECT_EQ(refused(scene, paper_law()), Keys{"effects.nonlocal"});
}

TEST(DrumProblem, TakesTheMemoryOfItsLawAndRefusesItWithoutOneAndWithK) {
  FlowScene scene = paper_scene();
  scene.effects = {};
  scene.effects.memory = FlowMemory{};
  RheologyFit law = paper_law();
  expect_has(message_of<InputError>([&] { (void)drum_problem(scene, law); }), "effects.memory: carries");
  law.memory = MemoryLaw{.c = 6, .m = 1, .chi_deg = 20, .c_rho = 100, .mu = {{1e-5, 1}, {0.2, 0.35}}};
  const FlowProblem problem = drum_problem(scene, law);
  ASSERT_TRUE(problem.memory);
  EXPECT_EQ(problem.memory->turn, 1);
  EXPECT_EQ(problem.memory->law.c, 6);
  law.k = NormalStressRatio{.I = {1e-3, 1e-1}, .k = {0.95, 1}};
  expect_has(message_of<InputError>([&] { (void)drum_problem(scene, law); }), "effects.memory: turns");
}

}  // namespace
}  // namespace drumlin::drum_test
