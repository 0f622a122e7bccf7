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
    TestRun whole(scene);
    whole.to_step(50);
    Checkpoint checkpoint;
    checkpoint.scene = scene_text(scene), checkpoint.state = whole.state();
    write_checkpoint(folder.path() / "checkpoint.h5", checkpoint);
    const EndedRun rest(scene, read_checkpoint(folder.path() / "checkpoint.h5").state, 2);
    whole.to_end();
    expect_same(whole.bodies(), rest.bodies());
  });
}

void expect_cost(const Scene& scene, int unknowns, int velocities) {
  TestRun run(scene);
  EXPECT_EQ(run.stepper().unknowns_per_contact(), unknowns);
  EXPECT_EQ(run.stepper().velocities_per_body(), velocities);
  EXPECT_EQ(run.bodies().spin.empty(), velocities == 2);
  const ImpulseCache& memory = run.state().memory;
  while (memory.i.empty()) (void)run.step();
  EXPECT_EQ(memory.impulse.size(), unknowns * memory.i.size());
}

TEST(EveryEffect, CostsTheUnknownsOfItsType) {
  with_each_effect([](const std::string& name, const Scene& scene) {
    SCOPED_TRACE(name);
    expect_cost(scene, name == "rolling_resistance" ? 3 : 2, 3);
  });
  Scene plain = turning_drum(30);
  plain.effects.spin.reset();
  expect_cost(plain, 2, 2);
  plain.effects.friction.reset();
  expect_cost(plain, 1, 2);
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

/// Neither in the state nor in what is taken from it.
TEST(EveryEffect, ThatIsAbsentLeavesNothing) {
  Scene scene = turning_drum();
  scene.grains.materials = {{"glass"}, {"steel"}};  // which no law asks for
  scene.walls[0].material = "steel";
  TestRun run(scene);
  (void)run.step();
  const SimulationState& state = run.state();
  EXPECT_TRUE(state.driven.empty() && state.ends.empty() && state.marks.empty());
  EXPECT_FALSE(state.gravity || state.loads || state.traffic || state.left || state.cell || state.energy);
  EXPECT_TRUE(state.bodies.id.empty() && state.bodies.material.empty());
  EXPECT_TRUE(run.walls().open.empty() && run.walls().material_of_shape.empty());
  const Snapshot snapshot = run.take_snapshot();
  EXPECT_TRUE(snapshot.wall_open.empty() && snapshot.id.empty() && snapshot.mass.empty());
  EXPECT_FALSE(snapshot.cell);
  const WallStep step = wall_step(run.walls(), 0, 0.01);
  EXPECT_TRUE(step.driven.empty() && step.driven_of_shape.empty());
  scene.effects.friction->pairs = {{{"glass", "steel"}, 0.1}};
  EXPECT_EQ(Simulation(scene).state().bodies.material.size(), 60u);  // one byte per grain
  EXPECT_EQ(sizeof(Bodies{}.material[0]), 1u);
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
    const EnergyLedger ledger = *EndedRun(scene).state().energy;
    EXPECT_LE(std::abs(closing_error(ledger)), 1e-10 * ledger.turnover) << name;
  });
}

}  // namespace
}  // namespace drumlin
