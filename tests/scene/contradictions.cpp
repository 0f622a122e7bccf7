// What validate() finds: parts of a scene that do not fit together, each with the key and the place to
// change.
#include <gtest/gtest.h>

#include "tests/scene/example.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace testing;
using namespace particles;
namespace {

TEST(Contradiction, NoneInTheExample) { EXPECT_TRUE(scene_problems(example_scene).empty()); }

TEST(Contradiction, SpinWithoutFriction) {
  const auto text = replaced(example_scene, "[effects.friction]\ngrain_grain = 0.4\ngrain_wall = 0.9\n", "");
  expect_problem(text, {}, "s.toml:15:1: effects.spin", "without friction");
}

TEST(Contradiction, DynamicFrictionWithoutTheStaticOne) {
  std::string text = replaced(example_scene, "[effects.friction]\ngrain_grain = 0.4\ngrain_wall = 0.9\n", "");
  text = replaced(text, "[effects.spin]\n", "");
  expect_problem(text, {"effects.dynamic_friction={grain_grain=0.1, grain_wall=0.1, speed_mm_s=1}"},
                 "effects.dynamic_friction", "without friction");
}

TEST(Contradiction, PairsOfMaterialsThatCannotMeet) {
  const std::string key = "effects.friction.pairs.0.between";
  const auto pair = [](const std::string& names) {
    return "effects.friction.pairs=[{between=[" + names + "], value=0.1}]";
  };
  expect_problem({pair("\"glass\", \"wood\"")}, key, "two materials of the scene");
  const std::string of_glass = "grains.materials=[{name=\"glass\"}]";
  expect_problem({of_glass, "walls.0.material=wood", pair("\"wood\", \"wood\"")}, key, "never meet");
  expect_problem({of_glass, pair("\"glass\"")}, key, "(allowed: glass)");
  expect_problem({of_glass,
                  "effects.friction.pairs=[{between=[\"glass\", \"glass\"], value=0.1}, "
                  "{between=[\"glass\", \"glass\"], value=0.2}]"},
                 "effects.friction.pairs.1.between", "a pair before");
  expect_problem({"grains.materials=[{name=\"glass\"}, {name=\"glass\"}]"}, "grains.materials.1.name",
                 "twice");
}

TEST(Contradiction, RoughnessThatDoesNotFit) {
  expect_problem({"walls.0.rough={diameter_mm=2, spacing_mm=3}"}, "grains.generated.region",
                 "inside its radius of 14 mm");
  // Round a disc: clear of the region, then with its glued discs not.
  const std::string disc = replaced(example_scene, "shape = \"container\"\nradius_mm = 15",
                                    "shape = \"disc\"\ncenter_mm = [20.5, 0]\ndiameter_mm = 10");
  EXPECT_TRUE(scene_problems(disc, {"walls.0.rough={diameter_mm=0.9, spacing_mm=3}"}).empty());
  expect_problem(disc, {"walls.0.rough={diameter_mm=2, spacing_mm=3}"}, "grains.generated.region",
                 "crossed by wall");
  expect_problem({"walls.0.rough={diameter_mm=2, spacing_mm=1e-6}", "walls.0.radius_mm=16"},
                 "walls.0.rough.spacing_mm", "discs");
}

TEST(Contradiction, RotatingFrameOfAPeriodicDomain) {
  expect_problem(replaced(example_scene, "shape = \"container\"\nradius_mm = 15",
                          "shape = \"disc\"\ncenter_mm = [40, 0]\ndiameter_mm = 1"),
                 {"periodic_x={x_min_mm=-50, x_max_mm=50}", "effects.rotating_frame={speed_rpm=1}"},
                 "effects.rotating_frame", "periodic in x");
}

TEST(Contradiction, SizesThatDoNotFit) {
  expect_problem({"grains.generated.sizes={kind=\"lognormal\", median_mm=5, sigma=0.1}"},
                 "grains.generated.sizes.median_mm", "is 5");
  const auto sieves = [](const std::string& openings, const std::string& shares) {
    return "grains.generated.sizes={kind=\"sieve\", openings_mm=[" + openings + "], passing_share=[" +
           shares + "]}";
  };
  const std::string sizes = "grains.generated.sizes.";
  EXPECT_TRUE(scene_problems(example_scene, {sieves("3, 3.2, 3.6", "0, 0.4, 1")}).empty());
  EXPECT_TRUE(scene_problems(example_scene, {sieves("3.2, 3.4", "0.4, 0.4")}).empty());
  expect_problem({sieves("3.1, 3.2", "0.4")}, sizes + "passing_share", "has 1 shares");
  expect_problem({sieves("2, 3.2", "0.4, 0.5")}, sizes + "openings_mm", "holds 2");
  expect_problem({sieves("3.2, 3.2", "0.4, 0.5")}, sizes + "openings_mm", "ascending");
  expect_problem({sieves("3.2, 3.4", "0.5, 0.4")}, sizes + "passing_share", "falls");
  expect_problem({sieves("3, 3.4", "0.1, 0.4")}, sizes + "passing_share", "smallest");
  expect_problem({sieves("3.4, 3.6", "0.1, 0.4")}, sizes + "passing_share", "largest");
  // Half of 707 mm2 holds 41 grains of 8.55 mm2.
  expect_problem({"grains.generated.count=50", "grains.generated.sizes={kind=\"power_law\", exponent=0}"},
                 "grains.generated.count", "at most 41");
}

TEST(Contradiction, GrainsAroundWhatTheyDoNotKnow) {
  expect_problem({"grains.generated.around=[\"pin\"]"}, "grains.generated.around", "names no wall");
  expect_problem({"grains.generated.around=[\"drum\"]", "grains.generated.placement=\"deposited\""},
                 "grains.generated.around", "deposited");
}

TEST(Contradiction, RollingResistanceWithoutSpin) {
  expect_problem(replaced(example_scene, "[effects.spin]\n", ""),
                 {"effects.rolling_resistance={grain_grain=0.1, grain_wall=0.1}"},
                 "effects.rolling_resistance", "without spin");
}

TEST(Contradiction, ForceThatHasNoDirectionOrMeetsAGivenVelocity) {
  const auto motion = [](const std::string& keys) {
    return "stages.0.motions=[{wall=\"drum\", kind=\"force\", force_n_m=1, mass_kg_m=1, " + keys + "}]";
  };
  expect_problem({motion("direction=[0, 0]")}, "stages.0.motions.0.direction", "no length");
  expect_problem({motion("direction=[0, 1], velocity_mm_s=[1, 1]")}, "stages.0.motions.0.velocity_mm_s",
                 "along the direction");
  expect_problem({motion("direction=[0, 1]"), "effects.rotating_frame={speed_rpm=1}"},
                 "stages.0.motions.0.kind", "rotating frame");
}

TEST(Contradiction, CapturingWhatNoFileHolds) {
  const std::string key = "solver.capture_unconverged";
  expect_problem({key + "=1", "effects.rolling_resistance={grain_grain=0.1, grain_wall=0.1}"},
                 "effects.rolling_resistance", "third unknown");
  expect_problem(
      {key + "=1",
       "stages.0.motions=[{wall=\"drum\", kind=\"force\", force_n_m=1, mass_kg_m=1, direction=[0, 1]}]"},
      key, "moved by a force");
}

TEST(Contradiction, FrictionWithoutSpinIsNone) {
  EXPECT_TRUE(scene_problems(replaced(example_scene, "[effects.spin]\n", "")).empty());
}

TEST(Contradiction, StageNameThatBreaksTheLog) {
  expect_problem({"stages.1.name=\"b,c\""}, "stages.1.name", "comma");
}

TEST(Contradiction, StageWithBothLengthsOrNone) {
  expect_problem({"stages.1.duration_s=1"}, "stages.1.turns", "excludes duration_s");
  expect_problem(replaced(example_scene, "duration_s = 0.1\n", ""), {}, "s.toml:19:1: stages.0.duration_s",
                 "is missing");
}

TEST(Contradiction, TurnsOfNothing) {
  expect_problem(replaced(example_scene, "duration_s = 0.1\n", "turns = 1\n"), {},
                 "s.toml:21:9: stages.0.turns", "no rotation");
  expect_problem({"stages.1.motions.0.speed_rpm=0"}, "stages.1.turns", "0 rpm");
  expect_problem({"stages.1.motions=[{wall=\"drum\", kind=\"translation\", velocity_mm_s=[1, 0]}]"},
                 "stages.1.turns", "no rotation");
}

TEST(Contradiction, MotionOfNoWallOrOfOneTwice) {
  expect_problem({"stages.1.motions.0.wall=x"}, "stages.1.motions.0.wall", "(allowed: drum)");
}

TEST(Contradiction, MotionsThatCannotFollowEachOther) {
  const std::string rotation = "{wall=\"drum\", kind=\"rotation\", speed_rpm=60}";
  const std::string push = "direction=[0, 1], mass_kg_m=1}";
  const std::string force = "{wall=\"drum\", kind=\"force\", force_n_m=1, " + push;
  const auto motions = [](const std::string& list) { return "stages.1.motions=[" + list + "]"; };
  EXPECT_TRUE(scene_problems(example_scene, {motions(rotation + "," + rotation)}).empty());
  EXPECT_TRUE(scene_problems(example_scene, {motions(rotation + "," + force)}).empty());
  expect_problem({motions(force + "," + rotation)}, "stages.1.motions.0.kind", "the last motion");
  expect_problem(replaced(example_scene, "shape = \"container\"\nradius_mm = 15",
                          "shape = \"segment\"\nfrom_mm = [-30, -15]\nto_mm = [30, -15]"),
                 {motions(rotation + ", {wall=\"drum\", kind=\"pressure\", pressure_n_m2=1, " + push)},
                 "stages.1.motions.1.between", "turns");
  expect_problem({"walls.0.rough={diameter_mm=1, spacing_mm=1}", "grains.generated.region.radius_mm=14",
                  motions(rotation + ", {wall=\"drum\", kind=\"belt\", speed_mm_s=1}")},
                 "stages.1.motions.1.kind", "glued discs");
}

TEST(Contradiction, WallsThatActOnNoMaterial) {
  expect_problem({"walls.0.acts_on=[\"cork\"]", "grains.materials=[{name=\"glass\"}]"}, "walls.0.acts_on",
                 "\"cork\"");
}

TEST(Contradiction, StagesOfOneName) { expect_problem({"stages.1.name=settle"}, "stages.1.name", "twice"); }

TEST(Contradiction, RegionTooSmallForTheGrains) {
  expect_problem({"grains.generated.count=100"}, "grains.generated.count", "fit into the region");
}

TEST(Contradiction, RegionTooLargeForTheMemory) {
  expect_problem({"walls.0.radius_mm=1e6", "grains.generated.region.radius_mm=1e6",
                  "grains.generated.diameter_min_mm=0.1"},
                 "grains.generated.region", "has room for");
}

TEST(Contradiction, RegionTooWideToRollThrough) {
  expect_problem({"walls.0.radius_mm=1e6", "grains.generated.region.radius_mm=1e6",
                  "grains.generated.placement=deposited"},
                 "grains.generated.region", "diameters wide");
}

TEST(Contradiction, DepositedGrainsFillNoMoreThanARegion) {
  expect_problem({"grains.generated.count=10000", "grains.generated.placement=deposited"},
                 "grains.generated.count", "0.9 of the region");
}

TEST(Contradiction, RegionThatIsNone) {
  expect_problem({"grains.generated.region={shape=\"rectangle\", min_mm=[-5, 5], max_mm=[5, 5]}"},
                 "grains.generated.region.max_mm", "along z");
}

TEST(Contradiction, RegionTheWrongWayRoundIsNotComparedWithWalls) {
  const std::string knob =
      "[[walls]]\nname = \"knob\"\nshape = \"disc\"\ncenter_mm = [0, 0]\ndiameter_mm = 1\n";
  expect_problem(example_scene + knob,
                 {"grains.generated.region={shape=\"rectangle\", min_mm=[5, 5], max_mm=[-5, -5]}"},
                 "grains.generated.region.max_mm", "along x");
}

TEST(Contradiction, RegionOutsideTheContainer) {
  expect_problem({"grains.generated.region.radius_mm=16"}, "grains.generated.region", "reaches 16 mm");
  expect_problem({"grains.generated.region.center_mm=[1, 0]"}, "grains.generated.region", "reaches 16 mm");
}

TEST(Contradiction, RegionCrossedByAWall) {
  const std::string bar =
      "[[walls]]\nname = \"bar\"\nshape = \"segment\"\nfrom_mm = [-5, 0]\nto_mm = [5, 0]\n";
  expect_problem(example_scene + bar, {}, "grains.generated.region", "walls.1");
}

TEST(Contradiction, DiametersTheWrongWayRound) {
  expect_problem({"grains.generated.diameter_min_mm=4"}, "grains.generated.diameter_max_mm", ">= ");
}

TEST(Contradiction, SegmentWithoutLength) {
  const std::string bar =
      "[[walls]]\nname = \"bar\"\nshape = \"segment\"\nfrom_mm = [50, 0]\nto_mm = [50, 0]\n";
  expect_problem(example_scene + bar, {}, "s.toml:33:9: walls.1.to_mm", "where the segment begins");
}

TEST(Contradiction, PeriodicDomainWithAContainer) {
  expect_problem({"periodic_x={x_min_mm=-20, x_max_mm=20}"}, "walls.0.shape",
                 "container in a periodic domain");
}

TEST(Contradiction, PeriodicDomainTooShortOrBesideTheRegion) {
  auto text = replaced(example_scene, "shape = \"container\"\nradius_mm = 15",
                       "shape = \"disc\"\ncenter_mm = [0, -30]\ndiameter_mm = 1");
  EXPECT_TRUE(scene_problems(text, {"periodic_x={x_min_mm=-15, x_max_mm=15}"}).empty());
  expect_problem(text, {"periodic_x={x_min_mm=-10, x_max_mm=20}"}, "grains.generated.region",
                 "inside the domain");
  text = replaced(text, "region = { shape = \"circle\", radius_mm = 15 }",
                  "region = { shape = \"rectangle\", min_mm = [0, 0], max_mm = [10, 100] }");
  expect_problem(text, {"periodic_x={x_min_mm=0, x_max_mm=10}"}, "periodic_x.x_max_mm",
                 "3 of the largest grains");
}

TEST(Contradiction, StepsThatDoNotFitTheStage) {
  expect_problem({"stages.0.time_step_s=1"}, "stages.0.time_step_s", "makes 0 steps");
  expect_problem({"stages.0.time_step_s=1e-15"}, "stages.0.time_step_s", "steps");
  expect_problem({"stages.1.snapshots=101", "output.velocity_window_s=0"}, "stages.1.snapshots", "<= 100");
}

TEST(Contradiction, VelocityWindowThatDoesNotFitTheStepsOrSnapshots) {
  expect_problem({"output.velocity_window_s=6.5e-3"}, "output.velocity_window_s",
                 "is 6.5 steps of stage \"turn\"");
  expect_problem({"stages.1.snapshots=50"}, "output.velocity_window_s", "longer than the 0.002 s");
  EXPECT_TRUE(scene_problems(example_scene, {"output.velocity_window_s=0"}).empty());
}

TEST(Contradiction, JudgingLessOftenThanSweepingAtAll) {
  expect_problem({"solver.check_every=9000"}, "solver.check_every", "max_sweeps = 5000");
}

TEST(Contradiction, SolversForStudyAreRefusedWithTheCommandThatHasThem) {
  for (const char* name : {"nncg", "cpg", "reference", "nlgs-scalar", "accelerated-double", "none"})
    expect_problem({std::string("solver.name=") + name}, "solver.name", "drumlin solve-contacts --solver");
}

TEST(Contradiction, NoStageAtAll) { expect_problem({"stages=[]"}, "stages", "has 0 entries"); }

TEST(Contradiction, AbsurdNumbersEndInAMessage) {
  // None of these may hang, overflow or allocate without end.
  for (const char* wild :
       {"grains.generated.diameter_max_mm=1e-300", "grains.generated.region.radius_mm=1e300",
        "stages.0.duration_s=1e300", "stages.0.time_step_s=5e-324", "stages.1.motions.0.speed_rpm=1e-300",
        "grains.generated.region={shape=\"rectangle\", min_mm=[0,-1e6], max_mm=[1e-9,1e6]}",
        "grains.generated.count=1000000"})
    EXPECT_FALSE(scene_problems(example_scene, {wild}).empty()) << wild;
}

}  // namespace
}  // namespace drumlin
