// What holds for every effect, through the list of them: each alone, at a modest strength, in a small drum.
#include <gtest/gtest.h>

#include "particles/io/checkpoint_file.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/scene/validate.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
namespace {

/// Calls visit(name, scene) with a drum in which the effect acts, for one effect after the other.
template <class Visit>
void with_each_effect(Visit visit) {
  Scene scene = test::turning_drum(30);
  const Effects plain = scene.effects;
  scene.stages[0].duration_s = 0.1;
  each_effect(
      [&]<class E>(std::optional<E>& effect) {
        if (!effect) effect = E::modest();
        EXPECT_TRUE(faults_of(*effect, scene).empty()) << E::name;
        visit(std::string(E::name), scene);
        scene.effects = plain;
      },
      scene.effects);
}

TEST(EveryEffect, GoesOnFromACheckpointBitForBit) {
  const test::TemporaryFolder folder;
  with_each_effect([&](const std::string& name, const Scene& scene) {
    SCOPED_TRACE(name);
    Simulation whole(scene);
    while (whole.state().step < 50) (void)whole.step();
    Checkpoint checkpoint;
    checkpoint.scene = scene_text(scene), checkpoint.state = whole.state();
    write_checkpoint(folder.path() / "checkpoint.h5", checkpoint);
    Simulation rest(scene, read_checkpoint(folder.path() / "checkpoint.h5").state, 2);
    while (!whole.finished()) (void)whole.step(), (void)rest.step();
    test::expect_same(whole.state().bodies, rest.state().bodies);
  });
}

TEST(EveryEffect, StandsInTheSceneThatIsWrittenBack) {
  with_each_effect([](const std::string& name, const Scene& scene) {
    const std::string text = scene_text(scene);
    EXPECT_NE(text.find("[effects." + name), std::string::npos);
    EXPECT_EQ(scene_text(parse_scene(text, "scene.toml")), text);
  });
}

TEST(EveryEffect, LeavesALedgerThatCloses) {
  with_each_effect([](const std::string& name, Scene scene) {
    scene.output.energy_ledger = true;
    Simulation simulation(scene);
    while (!simulation.finished()) (void)simulation.step();
    const EnergyLedger& ledger = *simulation.state().energy;
    EXPECT_LE(std::abs(closing_error(ledger)), 1e-10 * ledger.turnover) << name;
  });
}

}  // namespace
}  // namespace drumlin
