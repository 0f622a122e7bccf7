// Grains generated around walls that stand in their region.
#include "particles/scene/placement.hpp"
#include "particles/scene/scene_walls.hpp"
#include "particles/scene/validate.hpp"
#include "particles/stepping/start_check.hpp"
#include "particles/stepping/step_laws.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// Shapes of all kinds in a box of 60 mm that is periodic in x; a pin reaches over the seam.
Scene pins(const GeneratedGrains& grains) {
  Scene scene = open_box(grains, 60, 200);
  scene.walls = {{"floor", SegmentShape{{0, 0}, {60, 0}}},
                 {"pins", DiscShape{{59, 10}, 8}},
                 {"pins", SegmentShape{{10, 5}, {20, 25}}},
                 {"pins", ArcShape{{40, 15}, 8, 200, 340}},
                 {"pins", PolylineShape{{5, 15, 25}, {40, 35, 40}}},
                 {"wheel", DiscShape{{30, 30}, 10}, {}, Roughness{2, 3}}};
  scene.periodic_x = PeriodicX{0, 60};
  auto& made = std::get<GeneratedGrains>(scene.grains.source);
  made.around = {"pins", "wheel"};
  return scene;
}

TEST(GeneratedAround, NoGrainOverlapsAShape) {
  const RectangleRegion box{{0, 0}, {60, 60}};
  for (const GeneratedGrains& grains :
       {GeneratedGrains{250, 1, 2, box}, GeneratedGrains{400, 0.5, 3, box, PowerLawSizes{2}}}) {
    const Scene scene = pins(grains);
    EXPECT_TRUE(validate(scene).empty());
    const Scales scales = scales_of(scene);
    const Bodies bodies = place_grains(scene, scales);
    ASSERT_EQ(bodies.count(), static_cast<std::size_t>(grains.count));
    const Walls walls = walls_of(scene, scales);
    const auto overlaps = [&](const Bodies& placed) {
      const auto shapes = walls.reference;
      return overlaps_at_start(placed, shapes, resting_steps(walls, {}), laws_of(scene, scales).period).depth;
    };
    EXPECT_LE(overlaps(bodies), 1e-9);
    // Grains that know nothing of them would.
    Scene blind = scene;
    std::get<GeneratedGrains>(blind.grains.source).around.reset();
    EXPECT_GT(overlaps(place_grains(blind, scales)), 0.1);
    EXPECT_FALSE(validate(blind).empty());
    EXPECT_NE(bodies.x, place_grains(blind, scales).x);
  }
}

TEST(GeneratedAround, WallsOutsideOfTheRegionChangeNothing) {
  Scene scene = turning_drum();
  scene.walls.push_back({"far", DiscShape{{100, 0}, 5}});
  const Bodies before = place_grains(scene, scales_of(scene));
  std::get<GeneratedGrains>(scene.grains.source).around = {"far"};
  expect_same(before, place_grains(scene, scales_of(scene)));
}

}  // namespace
}  // namespace drumlin
