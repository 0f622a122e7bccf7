// Stretches beyond the end of a run: closed forms of free fall, bounds that follow from a change, any number
// of threads.
#include "particles/stretches/paired_stretches.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "particles/scene/scene_file.hpp"
#include "tests/cost/drum_of_a_dozen.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin {
using namespace particles;
namespace {

SimulationState end_of(const Scene& scene) {
  Simulation simulation(scene);
  while (!simulation.finished()) (void)simulation.step();
  return simulation.state();
}

const StretchComparison* found(const PairedStretches& stretches, const std::string& quantity) {
  for (const StretchComparison& one : stretches.quantities)
    if (one.quantity == quantity) return &one;
  return nullptr;
}

TEST(PairedStretches, FreeFallChangesBySamplingAloneAndByNoSolver) {
  const test::TemporaryFolder folder;
  Scene scene = test::scene_of({{0, 0}, {10, 5}, {-10, 3}});
  scene.effects.gravity.emplace();
  test::add_stage(scene, 1, 0.02);
  const double unit_s = std::sqrt(1e-3 / 9.81), h = 0.02, T = 2, mass = 3 * std::numbers::pi / 4;
  const PairedStretches result = paired_stretches(scene, end_of(scene), T * unit_s, 1, [] {});
  const StretchComparison* energy = found(result, "kinetic_energy");
  ASSERT_NE(energy, nullptr);
  // v = t is exact; the mean of (v_k^2 + v_(k+1)^2)/2 from t = 1 to 3 is 13/3 + h^2/6.
  EXPECT_NEAR(energy->value, mass / 2 * (13.0 / 3 + h * h / 6), 1e-9);
  EXPECT_NEAR(energy->step.change, -mass / 2 * h * h / 8, 1e-9);
  EXPECT_NEAR(energy->solver.change, 0, 1e-12);
  EXPECT_EQ(found(result, "contact_force"), nullptr);  // nothing touches
  EXPECT_EQ(result.missed, 0);
  const StretchComparison* displacement = found(result, "displacement");
  ASSERT_NE(displacement, nullptr);
  EXPECT_NEAR(displacement->value, T / 10 * 2, 0.01);  // a tenth of the way from t = 1 to 3, 4 d in all
}

TEST(PairedStretches, GrainAtRestHasItsWeightWhateverTheSettings) {
  const test::TemporaryFolder folder;
  Scene scene = test::on_floor({{0, 0.5}});
  test::add_stage(scene, 1, 0.05);
  const PairedStretches result = paired_stretches(scene, end_of(scene), 0.02, 1, [] {});
  const StretchComparison* force = found(result, "contact_force");
  ASSERT_NE(force, nullptr);
  EXPECT_NEAR(force->value, std::numbers::pi / 4, 1e-6);
  EXPECT_LT(force->step.error_at_most, 1e-6);
  EXPECT_LT(force->solver.error_at_most, 1e-6);
  const StretchComparison* pressure = found(result, "pressure");
  ASSERT_NE(pressure, nullptr);
  EXPECT_NEAR(pressure->value, 0.5 / 2, 1e-6);  // r f_n/2 over the disc's area, f_n its weight
}

TEST(PairedStretches, AreTheSameForAnyNumberOfThreadsAndLeaveTheStateAlone) {
  const Scene scene = parse_scene(testing::drum_of_a_dozen, "dozen.toml");
  const SimulationState end = end_of(scene);
  const auto before = end.bodies.x;
  const auto blocks = [&](int threads) {
    return stretch_means(scene, end, 0.05, 5e-4, 1e-4, threads, [] {}).blocks;
  };
  const auto one = blocks(1), two = blocks(2);
  for (std::size_t q = 0; q < stretch_quantities.size(); ++q)
    for (std::size_t b = 0; b < stretch_blocks; ++b) EXPECT_EQ(one[q][b], two[q][b]) << q << ' ' << b;
  EXPECT_EQ(end.bodies.x, before);
}

TEST(PairedStretches, AChangeBoundsTheErrorByTheOrderOfItsSetting) {
  std::array<double, stretch_blocks> before{}, after{};
  for (std::size_t b = 0; b < stretch_blocks; ++b) {
    before[b] = static_cast<double>(b);
    after[b] = before[b] + 0.25;
  }
  const StretchChange change = change_between(before, after, error_over_step_change);
  EXPECT_NEAR(change.change, 0.25, 1e-15);
  EXPECT_NEAR(change.ci99, 0, 1e-12);  // the same in every block
  EXPECT_NEAR(change.error_at_most, 0.5, 1e-12);
}

}  // namespace
}  // namespace drumlin
