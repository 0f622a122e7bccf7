#include "continuum/model/flow_scene.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "coupling/exchange/errors.hpp"

namespace drumlin {
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

TEST(FlowScene, ReadsBackWhatItWrites) {
  const FlowScene scene =
      parse_flow_scene(smallest, "test", {"mesh.levels=3", "regularisation.pressure=0.125"});
  const std::string text = flow_scene_text(scene);
  EXPECT_EQ(flow_scene_text(parse_flow_scene(text, "again")), text);
  EXPECT_EQ(scene.mesh.levels, 3);
  EXPECT_EQ(scene.regularisation.pressure, 0.125);
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

TEST(FlowScene, ListsEveryKeyOnceWithASentence) {
  std::set<std::string> paths;
  for (const KeyRow& row : flow_scene_keys()) {
    EXPECT_FALSE(row.sentence.empty()) << row.path;
    EXPECT_TRUE(paths.insert(row.path).second) << row.path;
  }
  for (const char* path :
       {"drum.diameter_mm", "grains.count", "mesh.levels", "regularisation.pressure", "output.slice_width"})
    EXPECT_TRUE(paths.contains(path)) << path;
}

TEST(FlowScene, ShippedScenesAreThoseOfTheParticles) {
  const FlowScene full = read_flow_scene(DRUMLIN_DATA "/scenes/drum-6rpm-flow.toml");
  EXPECT_EQ(full.grains.count, 7183);
  EXPECT_FALSE(full.reduced);
  const FlowScene smoke = read_flow_scene(DRUMLIN_DATA "/scenes/drum-smoke-flow.toml");
  EXPECT_EQ(smoke.grains.count, 798);
  EXPECT_TRUE(smoke.reduced);
}

TEST(FlowScene, DocumentationHoldsEveryKey) {
  std::ifstream stream(DRUMLIN_DATA "/../docs/formats/flow.md");
  std::stringstream text;
  text << stream.rdbuf();
  EXPECT_NE(text.str().find(keys_as_markdown(flow_scene_keys())), std::string::npos)
      << "docs/formats/flow.md is behind: its table is the output of drumlin-flow --keys --markdown";
}

}  // namespace
}  // namespace drumlin
