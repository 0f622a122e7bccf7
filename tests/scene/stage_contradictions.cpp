// What validate() finds in stages that change something.
#include <gtest/gtest.h>

#include "tests/scene/example.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace testing;
namespace {

TEST(StageContradiction, WallsThatAreNotThere) {
  expect_problem({"stages.0.opens=[\"gate\"]"}, "stages.0.opens", "names no wall");
  expect_problem({"stages.1={name=\"on\", duration_s=0.1, time_step_s=1e-3, opens=[\"drum\", \"drum\"]}"},
                 "stages.1.opens", "has been opened");
  expect_problem({"stages.0.opens=[\"drum\"]"}, "stages.1.motions.0.wall", "has been opened");
  expect_problem({"stages.0.until={moved={wall=\"lid\", distance_mm=1}}"}, "stages.0.until.moved.wall",
                 "names no wall");
  expect_problem({"stages.0.until={}"}, "stages.0.until", "nothing to wait for");
}

TEST(StageContradiction, EffectsThatTheSceneDoesNotName) {
  const std::string values = "={grain_grain=0.1, grain_wall=0.1}";
  expect_problem({"stages.0.rolling_resistance" + values}, "stages.0.rolling_resistance",
                 "together with effects.rolling_resistance");
  expect_problem({"stages.0.cohesion" + values}, "stages.0.cohesion", "together with effects.cohesion");
  expect_problem({"effects.restitution" + values, "stages.0.restitution={grain_grain=1.5, grain_wall=0}"},
                 "stages.0.restitution.grain_grain", "0 to 1");
  expect_problem({"stages.0.gravity={direction_deg=-60}", "output.energy_ledger=true"}, "stages.0.gravity",
                 "without output.energy_ledger");
}

TEST(StageContradiction, StepsMustFollowWallsThatGoToAndFroAndGrainsThatFly) {
  const auto moved = [](const std::string& keys) {
    return "stages.1={name=\"shake\", duration_s=0.1, time_step_s=1e-3, motions=[{wall=\"drum\", " + keys +
           "}]}";
  };
  expect_problem({moved("kind=\"oscillation\", amplitude_mm=[0, 0.5], frequency_hz=251")},
                 "stages.1.motions.0.frequency_hz", "a period of 3.98 steps");
  expect_problem({moved("kind=\"rocking\", amplitude_deg=1, center_mm=[0, 0], frequency_hz=1000")},
                 "stages.1.motions.0.frequency_hz", "up to 250 Hz");
  expect_problem({"grains.thermal_speed_mm_s=1e6"}, "stages.0.time_step_s", "flies by");
}

// The smallest radius is 1.5 mm, a step 1 ms.
TEST(StageContradiction, WallsMoveByARadiusInAStepAtMost) {
  const auto moved = [](const std::string& keys) {
    return "stages.1={name=\"move\", duration_s=0.1, time_step_s=1e-3, motions=[{wall=\"drum\", " + keys +
           "}]}";
  };
  const std::string motion = "stages.1.motions.0.";
  const auto accepted = [&](const std::string& keys, const std::string& wall = "walls.0.name=\"drum\"") {
    const auto problems = scene_problems(example_scene, {moved(keys), wall});
    EXPECT_TRUE(problems.empty()) << keys << ": " << problems.front().text();
  };
  expect_problem({moved("kind=\"translation\", velocity_mm_s=[1600, 0]")}, motion + "velocity_mm_s",
                 "moves wall \"drum\" by 1.6 mm in a step of 0.001 s (allowed: up to 1.5 mm");
  accepted("kind=\"translation\", velocity_mm_s=[1500, 0]");
  expect_problem({moved("kind=\"oscillation\", amplitude_mm=[0, 10], frequency_hz=25")},
                 motion + "amplitude_mm", "by 1.57 mm");
  // A drum turns within itself, about its own centre; about another point it moves.
  accepted("kind=\"rotation\", speed_rpm=6000");
  expect_problem({moved("kind=\"rotation\", speed_rpm=6000, center_mm=[2.5, 0]")}, motion + "speed_rpm",
                 "by 1.57 mm");
  expect_problem({moved("kind=\"rocking\", amplitude_deg=90, frequency_hz=100, center_mm=[1.6, 0]")},
                 motion + "amplitude_deg", "by 1.58 mm");
  expect_problem({moved("kind=\"strain_rate\", direction=[2, 0], reference_mm=[-100, 0], rate_per_s=16")},
                 motion + "rate_per_s", "by 1.6 mm");
  // A gate may be drawn along itself as fast as one likes, not across.
  const std::string gate = "walls.0={name=\"drum\", shape=\"segment\", from_mm=[-20, -20], to_mm=[20, -20]}";
  accepted("kind=\"translation\", velocity_mm_s=[90000, 1500]", gate);
  expect_problem({moved("kind=\"rotation\", speed_rpm=750, center_mm=[0, -20]"), gate}, motion + "speed_rpm",
                 "by 1.57 mm");
  expect_problem({moved("kind=\"translation\", velocity_mm_s=[1600, 0]"),
                  gate.substr(0, gate.size() - 1) + ", rough={diameter_mm=3, spacing_mm=3}}"},
                 motion + "velocity_mm_s", "by 1.6 mm");
}

TEST(StageContradiction, StepsAreAsShortAsTheSmallestGrainsOfGroupsAndSourcesNeed) {
  const std::string region = "region={shape=\"rectangle\", min_mm=[-2, 10], max_mm=[2, 12]}";
  // 1e-5 m falls by g h^2 = 9.81e-6 m, 1e-6 m by ten diameters.
  const auto source = [&](const std::string& diameter) {
    return "sources=[{name=\"rain\", " + region + ", grains_per_s=1, diameter_min_mm=" + diameter +
           ", diameter_max_mm=1}]";
  };
  const std::string first = "stages=[{name=\"settle\", duration_s=0.1, time_step_s=1e-3}]";
  expect_problem({source("1e-3"), first}, "stages.0.time_step_s", "falls by 9.81 of the smallest diameters");
  EXPECT_TRUE(scene_problems(example_scene, {source("1e-2"), first}).empty());
}

TEST(StageContradiction, NamesAreFieldsOfTables) {
  expect_problem({"walls.0.name=\"a,b\"", "stages.1={name=\"still\", duration_s=0.1, time_step_s=1e-3}"},
                 "walls.0.name", "a comma");
}

TEST(StageContradiction, StrongerGravityNeedsAShorterStep) {
  expect_problem({"stages.1.gravity={acceleration_m_s2=9e5}"}, "stages.1.time_step_s", "falls by");
}

TEST(StageContradiction, ServoWallsThatLackSomething) {
  const auto motion = [](const std::string& keys) {
    return "stages.1={name=\"press\", duration_s=0.1, time_step_s=1e-3, motions=[{wall=\"drum\", " + keys +
           "}]}";
  };
  const std::string pressed = "kind=\"pressure\", direction=[0, 1], pressure_n_m2=1, mass_kg_m=1";
  expect_problem({motion(pressed)}, "stages.1.motions.0.wall", "no length");
  expect_problem({motion(pressed + ", between=[\"drum\", \"drum\"]")}, "stages.1.motions.0.between",
                 "two walls");
  expect_problem({motion("kind=\"strain_rate\", direction=[0, 0], reference_mm=[0, 0], rate_per_s=1")},
                 "stages.1.motions.0.direction", "no length");
}

TEST(StageContradiction, PolylinesThatAreNone) {
  const auto line = [](const std::string& keys) {
    return "walls=[{name=\"drum\", shape=\"polyline\", " + keys + "}]";
  };
  expect_problem({line("x_mm=[-90, 90, 91], z_mm=[-90, -90]")}, "walls.0.z_mm", "as many");
  expect_problem({line("x_mm=[-90, 90, 90], z_mm=[-90, -90, -90]")}, "walls.0.x_mm", "twice in a row");
  expect_problem({line("x_mm=[-90, 90], z_mm=[0, 0]")}, "grains.generated.region", "is crossed by");
}

TEST(StageContradiction, ArcsThatAreNone) {
  const auto arc = [](const std::string& keys) {
    return "walls=[{name=\"drum\", shape=\"arc\", center_mm=[0, 0], " + keys + "}]";
  };
  expect_problem({arc("radius_mm=400, from_deg=10, to_deg=10")}, "walls.0.to_deg", "above from_deg");
  expect_problem({arc("radius_mm=400, from_deg=-10, to_deg=350")}, "walls.0.to_deg", "by less than 360");
  expect_problem({arc("radius_mm=400, from_deg=0, to_deg=90, rough={diameter_mm=1, spacing_mm=1}")},
                 "walls.0.rough", "glued to an arc");
  expect_problem({arc("radius_mm=5, from_deg=0, to_deg=90")}, "grains.generated.region", "is crossed by");
}

TEST(StageContradiction, LoadsOnWallsOfARotatingFrame) {
  expect_problem({"effects.rotating_frame={speed_rpm=1}", "output.walls_every_s=0.1"}, "output.walls_every_s",
                 "rotating frame");
}

}  // namespace
}  // namespace drumlin
