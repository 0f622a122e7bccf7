#include "continuum/model/flow_scene.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "coupling/core/basics/errors.hpp"
#include "tests/support/data_folder.hpp"
#include "tests/support/says.hpp"

namespace drumlin::flow_scene_test {
using namespace continuum;
namespace {

const std::string smallest = R"(format = "drumlin-flow-scene-1"
[drum]
diameter_mm = 150
rotation_rpm = 15
[grains]
count = 798
diameter_min_mm = 3.0
diameter_max_mm = 3.6
density_kg_m3 = 2700
)";

std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_flow_scene(text, "test", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FlowScene, ReadsBackWhatItWrites) {
  const FlowScene scene =
      parse_flow_scene(smallest, "test", {"mesh.levels=3", "regularisation.pressure=0.125"});
  const std::string text = flow_scene_text(scene);
  EXPECT_EQ(flow_scene_text(parse_flow_scene(text, "again")), text);
  EXPECT_EQ(scene.mesh.levels, 3);
  EXPECT_EQ(scene.regularisation.pressure, 0.125);
}

TEST(FlowScene, TellsInItsTitleWhatWasChanged) {
  const std::string text = "title = \"Drum, 15 rpm\"\n" + smallest;
  EXPECT_EQ(parse_flow_scene(text, "test", {"drum.rotation_rpm=12", "solver.sensitivity=true"}).title,
            "Drum, 15 rpm [drum.rotation_rpm = 12]");
}

TEST(FlowScene, HasTheEffectsThatItNames) {
  EXPECT_FALSE(parse_flow_scene(smallest, "test").effects.inertia);
  const FlowScene scene =
      parse_flow_scene(smallest + "[effects.inertia]\n[effects.wall_slip]\nfriction = 0.95\n", "test");
  EXPECT_TRUE(scene.effects.inertia);
  EXPECT_FALSE(scene.effects.rotating_frame);
  EXPECT_EQ(scene.effects.wall_slip.value().friction, 0.95);
  const FlowEffects more = parse_flow_scene(smallest + "[effects.nonlocal]\nlength = 1.5\n", "test").effects;
  EXPECT_EQ(more.nonlocal.value().length, 1.5);
  EXPECT_THROW(parse_flow_scene(smallest + "[effects.wall_slip]\n", "test"), InputError);
  EXPECT_THROW(parse_flow_scene(smallest + "[effects.nonlocal]\nlength = -1\n", "test"), InputError);
  const FlowNonlocal creeping =
      parse_flow_scene(smallest + "[effects.nonlocal]\namplitude = 0.5\nthreshold = 0.26\n", "test")
          .effects.nonlocal.value();
  EXPECT_EQ(creeping.amplitude, 0.5);
  EXPECT_EQ(creeping.threshold, 0.26);
  EXPECT_FALSE(creeping.length);
  expect_has(refusal(smallest + "[effects.nonlocal]\nlength = 1\namplitude = 0.5\n", {}),
             "effects.nonlocal.amplitude");
  EXPECT_FALSE(scene.effects.moving_surface);
  EXPECT_EQ(parse_flow_scene(smallest + "[effects.moving_surface]\ndegree = 12\n", "test")
                .effects.moving_surface.value()
                .degree.value(),
            12);
  expect_has(refusal(smallest + "[effects.moving_surface]\n", {"drum.slope_deg=20"}), "drum.slope_deg");
  EXPECT_THROW(parse_flow_scene(smallest + "[effects.inertia]\nshare = 1\n", "test"), InputError);
}

TEST(FlowScene, ReportsEveryProblemAtOnce) {
  try {
    parse_flow_scene(smallest + "[mesh]\nlevels = 0\nsurface_cel = 1\n", "test", {"drum.rotation_rpm=-3"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 3u) << error.what();
    for (const auto& problem : error.problems()) EXPECT_FALSE(problem.what.empty());
  }
}

TEST(FlowScene, RefusesDiametersInTheWrongOrder) {
  EXPECT_THROW(parse_flow_scene(smallest, "test", {"grains.diameter_max_mm=2"}), InputError);
  EXPECT_THROW(parse_flow_scene(smallest, "test", {"drum.diameter_mm=3.2"}), InputError);
}

TEST(FlowScene, MarchesOnlyWhereItSaysHow) {
  EXPECT_FALSE(parse_flow_scene(smallest, "test").time);
  const std::string march = smallest + "[time]\nstep_s = 0.1\nsteps = 20\n";
  const FlowScene scene = parse_flow_scene(march + "ramp_s = 2\n", "test");
  EXPECT_EQ(scene.time.value().steps, 20);
  EXPECT_EQ(flow_scene_text(parse_flow_scene(flow_scene_text(scene), "again")), flow_scene_text(scene));
  EXPECT_THROW(parse_flow_scene(march + "ramp_s = 2.1\n", "test"), InputError);  // longer than the march
  EXPECT_THROW(parse_flow_scene(march + "[effects.rotating_frame]\n", "test"), InputError);
  EXPECT_THROW(parse_flow_scene(smallest + "[time]\nsteps = 20\n", "test"), InputError);
  EXPECT_THROW(parse_flow_scene(march + "[effects.memory]\n", "test"), InputError);
  EXPECT_TRUE(parse_flow_scene(smallest + "[effects.memory]\n", "test").effects.memory);
  EXPECT_FALSE(parse_flow_scene(smallest, "test").effects.memory);
  EXPECT_THROW(parse_flow_scene(march + "[effects.nonlocal]\nlength = 2\n", "test"), InputError);
}

const std::string grains = R"([grains]
diameter_min_mm = 3.0
diameter_max_mm = 3.6
density_kg_m3 = 2700
)";

std::string scene_with(const std::string& table) {
  return "format = \"drumlin-flow-scene-1\"\n" + table + "\n" + grains;
}

TEST(FlowScene, TakesOneOfFiveGeometries) {
  const std::vector<std::string> tables = {
      "[incline]\nheight_mm = 66\nslope_deg = 18.5",
      "[plane_shear]\ngap_mm = 66\nwall_speed_mm_s = 72\npressure_pa = 350",
      "[chute]\nhalf_width_mm = 33\npressure_pa = 2400",
      "[annulus]\ninner_radius_mm = 66\nouter_radius_mm = 132\nrotation_rpm = 13\npressure_pa = 350"};
  for (std::size_t k = 0; k < tables.size(); ++k) {
    const FlowScene scene = parse_flow_scene(scene_with(tables[k]), "test");
    EXPECT_EQ(scene.geometry.index(), k + 1) << tables[k];  // the drum is the first
    const std::string text = flow_scene_text(scene);
    EXPECT_EQ(flow_scene_text(parse_flow_scene(text, "again")), text);
    expect_lacks(text, "[boundary]");
  }
  expect_has(refusal(scene_with("")), "one table of drum, incline, plane_shear, chute, annulus");
  expect_has(refusal(scene_with(tables[0] + "\n" + tables[2])), "excludes");
}

TEST(FlowScene, RefusesWhatMeansNothingInItsGeometry) {
  const std::string chute = scene_with("[chute]\nhalf_width_mm = 33\npressure_pa = 2400");
  for (const std::string key : {"grains.count=3", "boundary.entrainment_length=3", "output.slice_width=3"}) {
    const std::string said = refusal(chute, {key});
    expect_has(said, key.substr(0, key.find_first_of(".=")));
    expect_has(said, "belongs to a drum");
  }
  expect_has(refusal(scene_with("[drum]\ndiameter_mm = 150\nrotation_rpm = 15")), "grains.count");
  expect_has(
      refusal(scene_with(
          "[annulus]\ninner_radius_mm = 66\nouter_radius_mm = 60\nrotation_rpm = 13\npressure_pa = 350")),
      "outer_radius_mm");
  const std::string annulus = scene_with(
      "[annulus]\ninner_radius_mm = 66\nouter_radius_mm = 132\nrotation_rpm = 13\npressure_pa = 350");
  for (const std::string number :
       {"annulus.inner_radius_mm=5e-324", "annulus.inner_radius_mm=1e-8", "annulus.pressure_pa=5e-324",
        "annulus.pressure_pa=100", "output.map_spacing=1e-9"})
    expect_has(refusal(annulus, {number}), number.substr(0, number.find('=')));
}

TEST(FlowScene, ShippedScenesAreRead) {
  const FlowScene full = read_flow_scene(drumlin::test::data_folder() / "scenes/drum-6rpm-flow.toml");
  EXPECT_EQ(full.grains.count, 7183);
  EXPECT_FALSE(full.reduced);
  const FlowScene smoke = read_flow_scene(drumlin::test::data_folder() / "scenes/drum-smoke-flow.toml");
  EXPECT_EQ(smoke.grains.count, 798);
  EXPECT_TRUE(smoke.reduced);
  for (const char* name : {"incline", "plane-shear", "chute", "annulus"})
    EXPECT_NO_THROW(
        read_flow_scene(drumlin::test::data_folder() / "scenes" / (std::string(name) + "-flow.toml")))
        << name;
}

}  // namespace
}  // namespace drumlin::flow_scene_test
