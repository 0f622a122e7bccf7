// The scenes under data/scenes are valid and say what the paper says.
#include <gtest/gtest.h>

#include <filesystem>

#include "particles/scene/scene_file.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin {
using namespace particles;
namespace {

const std::filesystem::path scenes = drumlin::test::data_folder() / "scenes";

double rotation_rpm(const Scene& scene) {
  return std::get<Rotation>(scene.stages.back().motions.at(0).motion).speed_rpm;
}

TEST(ShippedScenes, AreTheSixDrumsOfThePaper) {
  for (const double rpm : {2, 4, 5, 6, 10, 15}) {
    const Scene scene = read_scene(scenes / ("drum-" + std::to_string(static_cast<int>(rpm)) + "rpm.toml"));
    EXPECT_FALSE(scene.reduced);
    EXPECT_EQ(rotation_rpm(scene), rpm);
    const auto& grains = std::get<GeneratedGrains>(scene.grains.source);
    EXPECT_EQ(grains.count, 7183);
    EXPECT_EQ(grains.diameter_min_mm, 3.0);
    EXPECT_EQ(grains.diameter_max_mm, 3.6);
    EXPECT_EQ(scene.grains.density_kg_m3, 2700);
    EXPECT_EQ(std::get<ContainerShape>(scene.walls.at(0).shape).radius_mm, 225);
    EXPECT_EQ(scene.effects.friction.value().grain_grain, 0.4) << "the text's value, not the caption's";
    EXPECT_EQ(scene.effects.friction.value().grain_wall, 0.95);
    EXPECT_EQ(scene.effects.restitution.value().grain_grain, 0.46);
    EXPECT_EQ(scene.effects.restitution.value().grain_wall, 0.46);
    EXPECT_TRUE(scene.effects.spin);
    // Settle, one turn to steady flow, one turn sampled.
    ASSERT_EQ(scene.stages.size(), 3u);
    EXPECT_TRUE(scene.stages[0].motions.empty());
    EXPECT_EQ(scene.stages[1].turns, 1.0);
    EXPECT_EQ(scene.stages[2].turns, 1.0);
    EXPECT_EQ(scene.stages[2].snapshots, 400);
    EXPECT_EQ(scene.output.velocity_window_s, 6e-3);
  }
}

TEST(ShippedScenes, SmokeDrumIsMarkedReducedAndFilledAlike) {
  const Scene full = read_scene(scenes / "drum-6rpm.toml"), smoke = read_scene(scenes / "drum-smoke.toml");
  EXPECT_TRUE(smoke.reduced);
  const auto fill = [](const Scene& scene) {
    const double radius = std::get<ContainerShape>(scene.walls.at(0).shape).radius_mm;
    const auto& grains = std::get<GeneratedGrains>(scene.grains.source);
    const double a = grains.diameter_min_mm, b = grains.diameter_max_mm;
    const double mean_square = (a * a + a * b + b * b) / 3;  // of a uniform distribution
    return grains.count * mean_square / 4 / (radius * radius / 2);
  };
  EXPECT_NEAR(fill(full), 0.775, 1e-3);  // of half the drum
  EXPECT_NEAR(fill(smoke), fill(full), 1e-3);
}

TEST(ShippedScenes, RunAgainFromTheirResolvedText) {
  for (const auto& entry : std::filesystem::directory_iterator(scenes)) {
    const std::string name = entry.path().filename();
    if (entry.path().extension() != ".toml" || name.find("-flow.toml") != std::string::npos) continue;
    const std::string resolved = scene_text(read_scene(entry.path()));
    EXPECT_EQ(scene_text(parse_scene(resolved, name)), resolved) << name;
  }
}

}  // namespace
}  // namespace drumlin
