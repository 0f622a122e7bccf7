// Steps on ranks against those of one process: the same contact problem, measured by the same residual.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "particles/contact/residual.hpp"
#include "particles/distributed/rank_simulation.hpp"
#include "particles/distributed/runs_on_ranks.hpp"
#include "particles/scene/scene_file.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin::particles {
namespace {

/// 250 discs in a drum of 45 mm radius that stands and then turns.
std::string drum_text(const std::string& effects) {
  return "format = \"drumlin-scene-1\"\ntitle = \"drum\"\n" +
         test::generated_grains(250, "{ shape = \"circle\", radius_mm = 45 }") +
         "[[walls]]\nname = \"drum\"\nshape = \"container\"\nradius_mm = 45\n[effects.gravity]\n" + effects +
         "[[stages]]\nname = \"settle\"\nduration_s = 0.15\ntime_step_s = 1e-3\n"
         "[[stages]]\nname = \"turn\"\nduration_s = 0.1\ntime_step_s = 1e-3\n"
         "motions = [{ wall = \"drum\", kind = \"rotation\", speed_rpm = 30 }]\n"
         "[solver]\ntolerance = 1e-3\n";
}

Scene scene_of_text(const std::string& text) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "scene.toml";
  std::ofstream(file) << text;
  return read_scene(file, {});
}

const std::string all_effects =
    test::friction("0.4", "0.9") +
    "[effects.restitution]\ngrain_grain = 0.4\ngrain_wall = 0.4\n[effects.spin]\n";

/// The state after so many steps of one process.
SimulationState state_after(const Scene& scene, int steps) {
  Simulation simulation(scene);
  for (int k = 0; k < steps; ++k) (void)simulation.step();
  return simulation.state();
}

/// Residual of the impulses that ranks remember, in the contact problem that one process has for the same
/// step.
ContactResidual residual_on_one_process(const SimulationState& ranks, const Stepper& stepper) {
  std::map<std::pair<int, int>, std::pair<double, double>> impulses;
  const int dim = stepper.unknowns_per_contact();
  for (std::size_t m = 0; m < ranks.memory.i.size(); ++m)
    impulses[{ranks.memory.i[m], ranks.memory.j[m]}] = {ranks.memory.impulse[dim * m],
                                                        dim == 2 ? ranks.memory.impulse[dim * m + 1] : 0};
  const BlockProblem problem = stepper.last_problem().value();
  std::vector<double> r;
  for (const Candidate& pair : stepper.last_pairs()) {
    const auto [n, t] = impulses[{pair.i, pair.j}];
    r.push_back(n), r.push_back(t);
  }
  return residual_of(problem, r);
}

class RankStep : public testing::TestWithParam<std::pair<const char*, std::string>> {};

TEST_P(RankStep, SolvesTheProblemOfOneProcessToTheResidualThatItSays) {
  const Ranks ranks;
  const Scene scene = scene_of_text(drum_text(GetParam().second));
  ASSERT_TRUE(not_on_ranks(scene).empty());
  for (const int steps : {60, 149, 200}) {  // falling, at rest, turning
    const SimulationState state = state_after(scene, steps);
    Simulation one(scene, state);
    const StepReport right = one.step();
    RankSimulation many(scene, state, ranks, 1);
    const StepReport report = many.step();
    const SimulationState after = many.gathered_state();
    const double energy = many.kinetic_energy();
    EXPECT_EQ(report.contacts, right.contacts);
    EXPECT_EQ(report.impacts, right.impacts);
    EXPECT_EQ(report.solve.status, Status::converged);
    EXPECT_LE(report.solve.residual.rms, 1e-3);
    // Two solutions to 1e-3 of the same problem: velocities differ by some 1e-3 of h g, which is all there is
    // of them in a bed at rest.
    const double error = 1e-3 * one.plan().stages[0].time_step;
    EXPECT_NEAR(energy, kinetic_energy(one.state().bodies), 1e-2 * energy + 250 * error * error);
    EXPECT_NEAR(report.overlap.mean, right.overlap.mean, 1e-4);
    if (ranks.rank() != 0) continue;
    const ContactResidual residual = residual_on_one_process(after, one.stepper());
    // A frictionless problem has twice as many entries there, half of them 0 (block_problem.hpp).
    const double layout = one.stepper().unknowns_per_contact() == 1 ? std::sqrt(2) : 1;
    EXPECT_NEAR(residual.rms / layout, report.solve.residual.rms, 1e-9);
    EXPECT_NEAR(residual.max / layout, report.solve.residual.max, 1e-8);
    EXPECT_NEAR(residual.penetration, report.solve.residual.penetration, 1e-12);
    double far = 0;
    for (std::size_t b = 0; b < after.bodies.count(); ++b)
      far = std::max(far, std::hypot(after.bodies.x[b] - one.state().bodies.x[b],
                                     after.bodies.z[b] - one.state().bodies.z[b]));
    EXPECT_LE(far, 1e-2);
  }
}

INSTANTIATE_TEST_SUITE_P(Effects, RankStep,
                         testing::Values(std::pair("All", all_effects),
                                         std::pair("Frictionless", std::string()),
                                         std::pair("WithoutSpin", test::friction("0.4", "0.9"))),
                         [](const auto& tested) { return std::string(tested.param.first); });

TEST(RankSimulation, GoesOnFromItsOwnStateAsIfItHadNotStopped) {
  const Ranks ranks;
  const Scene scene = scene_of_text(drum_text(all_effects));
  RankSimulation through(scene, ranks, 1);
  for (int k = 0; k < 120; ++k) (void)through.step();
  SimulationState state = through.gathered_state();
  // All ranks read a checkpoint: here the first tells them what would stand in it.
  for (auto* values :
       {&state.bodies.x, &state.bodies.z, &state.bodies.v_x, &state.bodies.v_z, &state.bodies.spin,
        &state.bodies.radius, &state.bodies.inverse_mass, &state.memory.impulse})
    ranks.broadcast(*values);
  ranks.broadcast(state.memory.i), ranks.broadcast(state.memory.j);
  RankSimulation again(scene, state, ranks, 1);
  for (int k = 0; k < 10; ++k) (void)through.step(), (void)again.step();
  const SimulationState a = through.gathered_state(), b = again.gathered_state();
  EXPECT_EQ(a.bodies.x, b.bodies.x);
  EXPECT_EQ(a.bodies.v_z, b.bodies.v_z);
  EXPECT_EQ(a.bodies.spin, b.bodies.spin);
  EXPECT_EQ(a.memory.impulse, b.memory.impulse);
}

TEST(RankSimulation, NamesAGrainThatLeavesItsDomain) {
  const Ranks ranks;
  // Grain 1 flies off a floor without sides.
  const test::TemporaryFolder folder;
  Scene scene = test::scene_of({{0, 0.5}, {3, 0.5, 1, 100, 0}}, folder);
  scene.walls.push_back({"floor", SegmentShape{{-3, 0}, {5, 0}}});
  scene.effects.gravity.emplace();
  test::add_stage(scene, 10, 0.01);
  RankSimulation simulation(scene, ranks, 1);
  try {
    while (!simulation.finished()) (void)simulation.step();
    ADD_FAILURE() << "the grain was not missed";
  } catch (const NotConvergedError& error) {
    EXPECT_NE(std::string(error.what()).find("grain 1 is lost"), std::string::npos) << error.what();
  }
}

TEST(NotOnRanks, NamesEachKeyThatRanksDoNotKnow) {
  Scene scene = scene_of_text(drum_text(all_effects));
  EXPECT_TRUE(not_on_ranks(scene).empty());
  scene.periodic_x.emplace();
  scene.output.energy_ledger = true;
  scene.solver.name = "cpg";
  std::vector<std::string> keys;
  for (const InputProblem& problem : not_on_ranks(scene)) keys.push_back(problem.key);
  EXPECT_EQ(keys, (std::vector<std::string>{"periodic_x", "output.energy_ledger", "solver.name"}));
}

}  // namespace
}  // namespace drumlin::particles
