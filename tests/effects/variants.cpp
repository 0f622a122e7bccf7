// The variants of a scene that `drumlin cost --effects` prices.
#include <algorithm>

#include "particles/scene/effect_variants.hpp"
#include "particles/scene/scene_file.hpp"
#include "tests/effects/drums.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

const EffectVariant* find(const std::vector<EffectVariant>& variants, const std::string& effect,
                          EffectChange change) {
  const auto found = std::find_if(variants.begin(), variants.end(), [&](const EffectVariant& v) {
    return v.effect == effect && v.change == change;
  });
  return found == variants.end() ? nullptr : &*found;
}

TEST(EffectVariants, TakeAwayWhatIsNamedAndAddWhatIsNot) {
  const auto variants = effect_variants(turning_drum(12));
  ASSERT_EQ(variants.front().change, EffectChange::none);
  const auto expect_change = [&](EffectChange change, EffectChange other, auto... effects) {
    for (const char* effect : {effects...}) {
      const EffectVariant* found = find(variants, effect, change);
      ASSERT_NE(found, nullptr) << effect;
      EXPECT_EQ(find(variants, effect, other), nullptr) << effect;
      EXPECT_NE(scene_text(found->scene), scene_text(variants.front().scene)) << effect;
    }
  };
  expect_change(EffectChange::removed, EffectChange::added, "gravity", "friction", "spin", "restitution",
                "sizes");
  expect_change(EffectChange::added, EffectChange::removed, "rolling_resistance", "pairs", "cohesion",
                "rotating_frame", "rough walls");
  EXPECT_FALSE(find(variants, "spin", EffectChange::removed)->scene.effects.spin);
  EXPECT_TRUE(find(variants, "cohesion", EffectChange::added)->scene.effects.cohesion);
}

TEST(EffectVariants, RunOrSayWhyNot) {
  for (const auto& variant : effect_variants(turning_drum(12))) {
    EXPECT_EQ(variant.refused, "") << variant.effect;
    TestRun run(variant.scene);
    for (int k = 0; k < 5; ++k) (void)run.step();
  }
  // Grains that fill a box to its walls leave no room for glued discs.
  Scene full = turning_drum(12);
  full.grains.source = GeneratedGrains{4, 3, 3.6, RectangleRegion{{-20, -20}, {20, 20}}};
  full.walls = {{"floor", SegmentShape{{-20, -20}, {20, -20}}}};
  full.stages[0].motions.clear();
  const auto variants = effect_variants(full);
  const auto* rough = find(variants, "rough walls", EffectChange::added);
  ASSERT_NE(rough, nullptr);
  expect_has(rough->refused, "crossed by wall");
}

TEST(EffectVariants, StopWallsThatShakeOrArePushed) {
  Scene scene = turning_drum(12);
  scene.walls.push_back({"lid", SegmentShape{{-15, 15}, {15, 15}}});
  scene.stages[0].motions = {{"drum", Rocking{20, 4, 10, {0, 0}}},
                             {"lid", ForceControl{{0, -1}, 20, 0.05, {}}}};
  const auto variants = effect_variants(scene);
  EXPECT_EQ(find(variants, "oscillating walls", EffectChange::removed)->scene.stages[0].motions.size(), 1u);
  EXPECT_EQ(find(variants, "walls moved by a force", EffectChange::removed)->scene.stages[0].motions.size(),
            1u);
  // A force knows no rotating frame.
  EXPECT_NE(find(variants, "rotating_frame", EffectChange::added)->refused, "");
}

}  // namespace
}  // namespace drumlin
