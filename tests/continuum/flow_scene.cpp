// Flow scenes; what single keys may hold is tests/documents/every_document.cpp.
#include "continuum/model/flow_scene.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "coupling/core/files/text_file.hpp"
#include "tests/support/data_folder.hpp"
#include "tests/support/says.hpp"

namespace drumlin::flow_scene_test {
using namespace continuum;
namespace {

/// A shipped scene.
std::string text_of(const std::string& name) {
  return file_text(drumlin::test::data_folder() / "scenes" / (name + "-flow.toml"));
}
FlowScene drum(const std::vector<std::string>& overrides = {}) {
  return parse_flow_scene(text_of("drum-6rpm"), "test", overrides);
}

std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return message_of<InputError>([&] { (void)parse_flow_scene(text, "test", overrides); });
}

void expect_read_back(const FlowScene& scene) {
  const std::string text = flow_scene_text(scene);
  EXPECT_EQ(flow_scene_text(parse_flow_scene(text, "again")), text);
}

TEST(FlowScene, ReadsBackWhatItWrites) {
  const FlowScene scene = drum({"mesh.levels=3", "regularisation.pressure=0.125"});
  expect_read_back(scene);
  EXPECT_EQ(scene.mesh.levels, 3);
  EXPECT_EQ(scene.regularisation.pressure, 0.125);
}

TEST(FlowScene, TellsInItsTitleWhatWasChanged) {
  EXPECT_EQ(drum({"drum.rotation_rpm=12", "solver.sensitivity=true"}).title,
            drum().title + " [drum.rotation_rpm = 12]");
}

TEST(FlowScene, HasTheEffectsThatItNamesAndNoOther) {
  const FlowEffects none = drum().effects;
  EXPECT_FALSE(none.inertia || none.rotating_frame || none.wall_slip || none.nonlocal ||
               none.moving_surface || none.memory || drum().time);
  const FlowEffects all =
      drum({"effects.inertia={}", "effects.wall_slip={friction=0.95}", "effects.memory={}",
            "effects.nonlocal={amplitude=0.5, threshold=0.26}", "effects.moving_surface={degree=12}"})
          .effects;
  EXPECT_TRUE(all.inertia && all.memory);
  EXPECT_FALSE(all.rotating_frame || all.nonlocal.value().length);
  EXPECT_EQ(all.wall_slip.value().friction, 0.95);
  EXPECT_EQ(all.nonlocal->amplitude, 0.5);
  EXPECT_EQ(all.nonlocal->threshold, 0.26);
  EXPECT_EQ(all.moving_surface.value().degree.value(), 12);
  const FlowScene march = drum({"time={step_s=0.1, steps=20, ramp_s=2}"});
  EXPECT_EQ(march.time.value().steps, 20);
  expect_read_back(march);
}

TEST(FlowScene, TakesOneOfItsGeometries) {
  const char* names[] = {"drum-smoke", "incline", "plane-shear", "chute", "annulus", "column-collapse"};
  for (std::size_t k = 0; k < std::size(names); ++k) {
    const FlowScene scene = parse_flow_scene(text_of(names[k]), "test");
    EXPECT_EQ(scene.geometry.index(), k) << names[k];
    expect_read_back(scene);
    EXPECT_EQ(flow_scene_text(scene).find("[boundary]") == std::string::npos, k > 0) << names[k];
  }
  EXPECT_EQ(drum().grains.count, 7183);
  EXPECT_FALSE(drum().reduced);
  const FlowScene smoke = parse_flow_scene(text_of("drum-smoke"), "test");
  EXPECT_EQ(smoke.grains.count, 798);
  EXPECT_TRUE(smoke.reduced);
  const std::string grains = "[grains]\ndiameter_min_mm = 3.0\ndiameter_max_mm = 3.6\ndensity_kg_m3 = 2700\n";
  const std::string format = "format = \"drumlin-flow-scene-1\"\n";
  expect_has(refusal(format + grains), "one table of drum, incline, plane_shear, chute, annulus, region");
  expect_has(refusal(format + "[drum]\ndiameter_mm = 150\nrotation_rpm = 15\n" + grains), "grains.count");
}

TEST(FlowScene, NamesTheKeyOfWhatDoesNotFitTogether) {
  const auto table = nlohmann::json::parse(
      file_text(drumlin::test::data_folder().parent_path() / "tests/continuum/flow_contradictions.json"),
      nullptr, true, true);
  for (const auto& [scene, rows] : table.items())
    for (const auto& row : rows) {
      SCOPED_TRACE(row.dump());
      if (row.size() == 1) {
        EXPECT_NO_THROW(parse_flow_scene(text_of(scene), "test", row[0]));
        continue;
      }
      const std::string said = refusal(text_of(scene), row[0]);
      expect_has(said, row[1].get<std::string>() + ": ");
      expect_has(said, row[2].get<std::string>());
    }
}

}  // namespace
}  // namespace drumlin::flow_scene_test
