// What holds for every effect, through the list of them: each alone, at a modest strength, in a small drum.
#include <gtest/gtest.h>

#include "particles/io/checkpoint_file.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/scene/validate.hpp"
#include "tests/effects/drums.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// Calls visit(name, scene) with a drum in which the effect acts, for one effect after the other.
template <class Visit>
void with_each_effect(Visit visit) {
  Scene scene = turning_drum(30);
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
  const TemporaryFolder folder;
  with_each_effect([&](const std::string& name, const Scene& scene) {
    SCOPED_TRACE(name);
    Simulation whole(scene);
    while (whole.state().step < 50) (void)whole.step();
    Checkpoint checkpoint;
    checkpoint.scene = scene_text(scene), checkpoint.state = whole.state();
    write_checkpoint(folder.path() / "checkpoint.h5", checkpoint);
    Simulation rest(scene, read_checkpoint(folder.path() / "checkpoint.h5").state, 2);
    while (!whole.finished()) (void)whole.step(), (void)rest.step();
    expect_same(whole.state().bodies, rest.state().bodies);
  });
}

TEST(EveryEffect, CostsTheUnknownsOfItsType) {
  with_each_effect([](const std::string& name, const Scene& scene) {
    Simulation simulation(scene);
    const int unknowns = name == "rolling_resistance" ? 3 : 2;
    EXPECT_EQ(simulation.stepper().unknowns_per_contact(), unknowns) << name;
    EXPECT_EQ(simulation.stepper().velocities_per_body(), 3) << name;
    while (simulation.state().memory.i.empty()) (void)simulation.step();
    EXPECT_EQ(simulation.state().memory.impulse.size(), unknowns * simulation.state().memory.i.size())
        << name;
  });
}

/// Effects of no strength, stages that repeat the effect's values, pairs that repeat the common ones.
TEST(EveryEffect, ThatChangesNothingChangesNoBit) {
  Scene plain = turning_drum();
  const auto expect_no_change = [&plain](auto change) {
    Scene other = plain;
    change(other);
    expect_same(bodies_at_end(plain), bodies_at_end(other));
  };
  expect_no_change([](Scene& s) { s.effects.cohesion = Cohesion{0, 0}; });
  expect_no_change([](Scene& s) { s.effects.rotating_frame = RotatingFrame{0, {1, 2}}; });
  expect_no_change([](Scene& s) { s.effects.dynamic_friction = DynamicFriction{{0.4, 0.95}, 10}; });
  expect_no_change([](Scene& s) {
    s.grains.materials = {{"glass", 2}, {"steel", 1}};
    s.effects.friction->pairs = {{{"glass", "steel"}, 0.4}, {{"glass", "glass"}, 0.4}};
    s.effects.restitution->pairs = {{{"glass", "steel"}, 0.46}};
  });
  plain.stages[0].motions.clear();
  expect_no_change([](Scene& s) { s.stages[0].motions = {{"drum", Oscillation{{0, 0}, 5, 0}}}; });
  expect_no_change([](Scene& s) { s.stages[0].motions = {{"drum", Rocking{0, 5, 0, {0, 0}}}}; });
  plain = turning_drum();
  plain.effects.cohesion = Cohesion{1, 2};
  expect_no_change([](Scene& s) { s.stages[0].effects.cohesion = {1, 2}; });
}

TEST(EveryEffect, StandsInTheSceneThatIsWrittenBack) {
  with_each_effect([](const std::string& name, const Scene& scene) {
    const std::string text = scene_text(scene);
    expect_has(text, "[effects." + name);
    EXPECT_EQ(scene_text(parse_scene(text, "scene.toml")), text);
  });
}

TEST(EveryEffect, LeavesALedgerThatCloses) {
  with_each_effect([](const std::string& name, Scene scene) {
    scene.output.energy_ledger = true;
    EndedSimulation simulation(scene);
    const EnergyLedger& ledger = *simulation.state().energy;
    EXPECT_LE(std::abs(closing_error(ledger)), 1e-10 * ledger.turnover) << name;
  });
}

}  // namespace
}  // namespace drumlin
