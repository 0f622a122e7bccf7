// Friction and restitution that differ from pair to pair of materials.
#include <fstream>
#include <numeric>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/placement.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// Grains of diameter 1 (d), each with the name of its material.
struct Made {
  double x, z, v_x;
  std::string material;
};
TestScene scene_of_materials(const std::vector<Made>& grains) {
  TestScene scene = scene_of(std::vector<Grain>{});
  std::ofstream out(std::get<ListedGrains>(scene.grains.source).file);
  out.precision(17);
  out << "x_mm,z_mm,diameter_mm,v_x_mm_s,material\n";
  for (const Made& g : grains) out << g.x << ',' << g.z << ",1," << g.v_x * mm_s << ',' << g.material << '\n';
  scene.grains.materials = {{"glass"}, {"steel"}};
  return scene;
}

TEST(MaterialPairs, EachGrainSlidesWithTheFrictionOfItsPairOrElseTheCommonOne) {
  // Without spin a disc slides like a block: v = v0 - mu g t.
  const auto speeds = [](std::optional<std::string> of_floor, const Friction& friction) {
    TestScene scene = scene_of_materials({{0, 0.5, 1, "glass"}, {-10, 0.5, 1, "steel"}})
                          .between({floor_wall()})
                          .with(Gravity{}, friction)
                          .lasting(1, 1e-2);
    scene.walls[0].material = of_floor;
    return bodies_at_end(scene).v_x;
  };
  const auto named = speeds("wood", {0.4, 0.5, {{{"glass", "wood"}, 0.1}, {{"wood", "steel"}, 0.3}}}),
             common = speeds({}, {0.4, 0.5, {{{"glass", "steel"}, 0.1}}});
  EXPECT_NEAR(named[0], 1 - 0.1, 1e-9);
  EXPECT_NEAR(named[1], 1 - 0.3, 1e-9);
  for (const double v : common) EXPECT_NEAR(v, 1 - 0.5, 1e-9);
}

TEST(MaterialPairs, HeadOnImpactsPartWithTheRestitutionOfThePair) {
  // Equal masses: after the impact the first moves with (1 - e)/2, the second with (1 + e)/2 of the speed.
  const Bodies end = bodies_at_end(
      scene_of_materials(
          {{0, 0, 1, "glass"}, {1.05, 0, 0, "glass"}, {0, 10, 1, "glass"}, {1.05, 10, 0, "steel"}})
          .with(Restitution{0, 0, {{{"glass", "glass"}, 0.8}, {{"steel", "glass"}, 0.3}}})
          .lasting(0.2, 1e-2));
  const double expected[] = {(1 - 0.8) / 2, (1 + 0.8) / 2, (1 - 0.3) / 2, (1 + 0.3) / 2};
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(end.v_x[k], expected[k], 1e-9) << k;
}

TEST(MaterialPairs, SharesAreDrawnByNumber) {
  TestScene scene = scene_of(GeneratedGrains{4000, 3, 3.6, RectangleRegion{{0, 0}, {1000, 1000}}});
  scene.grains.materials = {{"glass", 3}, {"steel", 1}};
  scene.with(Friction{0.4, 0.4, {{{"glass", "steel"}, 0.1}}}).lasting(1, 0.1);
  const auto materials = place_grains(scene, scales_of(scene)).material;
  const auto steel = std::accumulate(materials.begin(), materials.end(), 0.0);
  EXPECT_NEAR(steel / 4000, 0.25, 4 * std::sqrt(0.25 * 0.75 / 4000));  // 4 standard deviations
}

TEST(WallsThatActOnAMaterial, LetOthersPass) {
  // Through a floor, from above and while lying in it, through a drum, and through a line that is jumped
  // over.
  const double t = 4;
  const auto end_of = [&](const Wall& wall, const std::vector<Made>& grains, double h, bool falls = false) {
    TestScene scene = scene_of_materials(grains).between({wall}).lasting(t, h);
    scene.walls[0].acts_on = {"steel"};
    TestRun run(falls ? scene.with(Gravity{}) : scene);
    run.each_step([](const StepReport& report) { EXPECT_FALSE(report.lost); });
    EXPECT_EQ(run.start_overlaps().pairs, 0);
    return run.bodies();
  };
  const Bodies fallen =
      end_of(floor_wall(), {{0, 2, 0, "glass"}, {5, 0, 0, "glass"}, {-5, 2, 0, "steel"}}, 1e-2, true);
  EXPECT_NEAR(fallen.z[0], 2 - t * t / 2, 1e-2 * t);  // to first order in the step
  EXPECT_NEAR(fallen.z[1], -t * t / 2, 1e-2 * t);
  EXPECT_NEAR(fallen.z[2], 0.5, 1e-6);
  const std::vector<Made> flying{{0, 2, 1, "glass"}, {0, -2, 1, "steel"}},
      jumping{{0, 2, 8, "glass"}, {0, -2, 1, "steel"}};
  const Bodies flown = end_of(drum_wall(3), flying, 1e-2);
  EXPECT_NEAR(flown.x[0], t, 1e-9);
  EXPECT_LT(std::hypot(flown.x[1], flown.z[1]), 2.5 + 1e-3);
  const Bodies jumped = end_of(segment("line", {3, -5}, {3, 5}), jumping, 0.25);
  EXPECT_NEAR(jumped.x[0], 8 * t, 1e-9);
  EXPECT_NEAR(jumped.x[1], 2.5, 1e-3);
}

TEST(MaterialPairs, AListThatNamesAnUnknownMaterialIsRefused) {
  const Scene scene =
      scene_of_materials({{0, 0.5, 1, "cork"}}).with(Friction{0.4, 0.5, {{{"glass", "steel"}, 0.1}}});
  EXPECT_THROW(place_grains(scene, scales_of(scene)), InputError);
}

}  // namespace
}  // namespace drumlin
