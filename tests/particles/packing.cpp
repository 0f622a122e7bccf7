// What many grains must do: nothing lost, nothing gained, the same bytes again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "coupling/common/errors.hpp"
#include "particles/detection/contact_list.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/scene/placement.hpp"
#include "particles/scene/random.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin {
using namespace particles;
namespace {

using test::add_stage;
using test::Grain;
using test::scene_of;
using test::TemporaryFolder;

/// A small drum with every effect.
Scene small_drum(int grains = 120) {
  Scene scene;
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source = GeneratedGrains{grains, 3, 3.6, CircleRegion{{0, 0}, 30}};
  scene.walls = {{"drum", ContainerShape{{0, 0}, 30}}};
  scene.effects = {Gravity{}, Friction{0.4, 0.95}, Restitution{0.46, 0.46}, Spin{}};
  Stage settle, turn;
  settle.name = "settle", settle.duration_s = 0.2, settle.time_step_s = 1e-3;
  turn.name = "turn", turn.duration_s = 0.4, turn.time_step_s = 1e-3, turn.snapshots = 4;
  turn.motions = {{"drum", Rotation{20, {0, 0}}}};
  scene.stages = {settle, turn};
  return scene;
}

void expect_same(const Bodies& a, const Bodies& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.v_x, b.v_x);
  EXPECT_EQ(a.v_z, b.v_z);
  EXPECT_EQ(a.spin, b.spin);
}

TEST(Drum, NothingLeavesAndOverlapStaysSmall) {
  Simulation simulation(small_drum());
  const double radius = 30 / 3.3;
  while (!simulation.finished()) {
    const StepReport report = simulation.step();
    // Before positions are corrected. In one step in which discs land after an impact: 1.33e-3.
    ASSERT_LT(report.overlap.mean, 1.4e-3);
    const Bodies& b = simulation.state().bodies;
    for (std::size_t k = 0; k < b.count(); ++k)
      ASSERT_LT(std::hypot(b.x[k], b.z[k]) + b.radius[k], radius + 0.02);
  }
}

TEST(Drum, SettlesToRest) {
  Scene scene = small_drum();
  scene.stages.pop_back();
  scene.stages[0].duration_s = 1.0;
  Simulation simulation(scene);
  while (!simulation.finished()) (void)simulation.step();
  const Bodies& b = simulation.state().bodies;
  double mass = 0;
  for (const double w : b.inverse_mass) mass += 1 / w;
  EXPECT_LT(std::sqrt(2 * kinetic_energy(b) / mass), 1e-2);
}

TEST(Restart, ContinuesBitForBitThroughAFile) {
  const TemporaryFolder folder;
  Simulation whole(small_drum());
  while (!whole.finished()) {
    (void)whole.step();
    if (whole.snapshot_due()) (void)whole.take_snapshot();
  }
  Simulation first(small_drum());
  for (int k = 0; k < 333; ++k) {
    (void)first.step();
    if (first.snapshot_due()) (void)first.take_snapshot();
  }
  Checkpoint checkpoint;
  checkpoint.scene = "scene";
  checkpoint.state = first.state();
  write_checkpoint(folder.path() / "checkpoint.h5", checkpoint);
  Simulation second(small_drum(), read_checkpoint(folder.path() / "checkpoint.h5").state);
  while (!second.finished()) {
    (void)second.step();
    if (second.snapshot_due()) (void)second.take_snapshot();
  }
  expect_same(whole.state().bodies, second.state().bodies);
  EXPECT_EQ(whole.state().memory.impulse, second.state().memory.impulse);
  EXPECT_EQ(whole.state().snapshots, second.state().snapshots);
}

TEST(Restart, KeepsTheDisplacementWindowThatItFellInto) {
  Scene scene = small_drum();
  Simulation whole(scene), first(scene);
  for (int k = 0; k < 297; ++k)
    (void)whole.step(), (void)first.step();  // the snapshot is due at step 300, its window of 6
  Simulation second(scene, first.state());
  for (int k = 0; k < 3; ++k) (void)whole.step(), (void)second.step();
  ASSERT_TRUE(whole.snapshot_due());
  const Snapshot a = whole.take_snapshot(), b = second.take_snapshot();
  ASSERT_FALSE(a.displacement_x.empty());
  EXPECT_NEAR(a.velocity_window * a.scales.time_s, 6e-3, 1e-12);
  EXPECT_EQ(a.displacement_x, b.displacement_x);
}

TEST(Frame, GalileanShiftChangesNothing) {
  const TemporaryFolder folder, other;
  std::vector<Grain> grains;
  for (int k = 0; k < 12; ++k)
    grains.push_back({1.01 * (k % 4), 1.02 * (k / 4), 1, 0.3 * (k % 3) - 0.3, -0.2 * (k / 4)});
  auto moving = grains;
  for (auto& g : moving) g.v_x += 5, g.v_z -= 3;
  const auto end = [](const std::vector<Grain>& list, const TemporaryFolder& where) {
    Scene scene = scene_of(list, where);
    scene.effects.friction = Friction{0.3, 0.3};
    scene.effects.spin = Spin{};
    add_stage(scene, 1, 0.01);
    Simulation simulation(scene);
    while (!simulation.finished()) (void)simulation.step();
    return simulation.state().bodies;
  };
  const Bodies a = end(grains, folder), b = end(moving, other);
  for (std::size_t k = 0; k < a.count(); ++k) {
    EXPECT_NEAR(b.x[k] - a.x[k], 5, 1e-6);
    EXPECT_NEAR(b.z[k] - a.z[k], -3, 1e-6);
    EXPECT_NEAR(a.spin[k], b.spin[k], 1e-6);
  }
}

TEST(Frame, RotationTurnsTheResultWithIt) {
  // The same heap in gravity turned by 30 degrees, positions and velocities turned with it.
  const double angle = std::numbers::pi / 6, c = std::cos(angle), s = std::sin(angle);
  const auto turned = [c, s](Grain g) {
    return Grain{c * g.x - s * g.z,     s * g.x + c * g.z,     g.diameter,
                 c * g.v_x - s * g.v_z, s * g.v_x + c * g.v_z, g.spin};
  };
  std::vector<Grain> grains, other;
  for (int k = 0; k < 9; ++k)
    grains.push_back({1.01 * (k % 3) + 0.3 * (k / 3), 0.5 + 1.02 * (k / 3), 1, 0.1 * k, -0.3});
  for (const Grain& g : grains) other.push_back(turned(g));
  const auto end = [](const std::vector<Grain>& list, Point_mm from, Point_mm to, double down_deg) {
    const TemporaryFolder folder;
    Scene scene = scene_of(list, folder);
    scene.walls = {{"floor", SegmentShape{from, to}}};
    scene.effects = {Gravity{9.81, down_deg}, Friction{0.3, 0.3}, std::nullopt, Spin{}};
    scene.solver.max_sweeps = 20000;
    add_stage(scene, 0.5, 0.01);
    Simulation simulation(scene);
    while (!simulation.finished()) (void)simulation.step();
    return simulation.state().bodies;
  };
  const Bodies a = end(grains, {-20, 0}, {20, 0}, -90),
               b = end(other, {-20 * c, -20 * s}, {20 * c, 20 * s}, -60);
  for (std::size_t k = 0; k < a.count(); ++k) {
    EXPECT_NEAR(b.x[k], c * a.x[k] - s * a.z[k], 1e-5) << k;
    EXPECT_NEAR(b.z[k], s * a.x[k] + c * a.z[k], 1e-5) << k;
    EXPECT_NEAR(b.spin[k], a.spin[k], 1e-4) << k;
  }
}

TEST(Restart, StateOfAnotherSceneIsRefused) {
  Simulation first(small_drum());
  while (first.state().memory.i.empty()) (void)first.step();
  const auto refused = [&first](auto change) {
    SimulationState state = first.state();
    change(state);
    EXPECT_THROW(Simulation(small_drum(), state), InputError);
  };
  refused([](SimulationState& s) { s.stage = 7; });
  refused([](SimulationState& s) { s.bodies.v_x.pop_back(); });
  refused([](SimulationState& s) { s.bodies.spin.clear(); });
  refused([](SimulationState& s) { s.memory.impulse.pop_back(); });
  refused([](SimulationState& s) { s.memory.j[0] = 1 << 20; });
  refused([](SimulationState& s) { s.memory.j[0] = std::numeric_limits<std::int32_t>::min(); });
  refused([](SimulationState& s) { s.pose_at_start.clear(); });
}

TEST(Restart, GoesOnTheSameFromContactsInTheOrderOfASolve) {
  // As older checkpoints hold them.
  Simulation first(small_drum());
  while (first.state().memory.i.size() < 20) (void)first.step();
  SimulationState state = first.state();
  ContactMemory& memory = state.memory;
  std::reverse(memory.i.begin(), memory.i.end());
  std::reverse(memory.j.begin(), memory.j.end());
  for (std::size_t low = 0, high = memory.impulse.size(); low + 2 < high; low += 2) {
    high -= 2;
    std::swap_ranges(&memory.impulse[low], &memory.impulse[low] + 2, &memory.impulse[high]);
  }
  Simulation second(small_drum(), state);
  EXPECT_EQ(second.state().memory.impulse, first.state().memory.impulse);
  for (int k = 0; k < 5; ++k) (void)first.step(), (void)second.step();
  expect_same(first.state().bodies, second.state().bodies);
}

TEST(Overlap, JammedStartOpensSlowlyAndGivesNoKineticEnergy) {
  // Nine discs squeezed into a box by 5 %: nothing moves but the projection.
  const TemporaryFolder folder;
  std::vector<Grain> grains;
  for (int k = 0; k < 9; ++k) grains.push_back({0.95 * (k % 3), 0.95 * (k / 3)});
  Scene scene = scene_of(grains, folder);
  scene.effects.friction = Friction{0.4, 0.4};
  scene.effects.spin = Spin{};
  scene.solver.projection_sweeps = 100;
  add_stage(scene, 5, 0.05);
  Simulation simulation(scene);
  double mean = 1;
  while (!simulation.finished()) {
    (void)simulation.step();
    const Bodies& b = simulation.state().bodies;
    ASSERT_LT(kinetic_energy(b), 1e-20);
    double sum = 0;
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t j = 0; j < i; ++j)
        sum += std::max(0.0, 1 - std::hypot(b.x[i] - b.x[j], b.z[i] - b.z[j]));
    ASSERT_LE(sum, mean + 1e-12);
    mean = sum;
  }
  EXPECT_LT(mean, 0.6 * 12 * 0.05);
}

TEST(Effects, AbsentOnesCostNoUnknownAndNoState) {
  Scene scene = small_drum();
  EXPECT_EQ(Simulation(scene).stepper().unknowns_per_contact(), 2);
  EXPECT_EQ(Simulation(scene).stepper().velocities_per_body(), 3);
  scene.effects.spin.reset();
  EXPECT_EQ(Simulation(scene).stepper().unknowns_per_contact(), 2);
  EXPECT_EQ(Simulation(scene).stepper().velocities_per_body(), 2);
  EXPECT_TRUE(Simulation(scene).state().bodies.spin.empty());
  scene.effects.friction.reset();
  scene.effects.restitution.reset();
  Simulation plain(scene);
  EXPECT_EQ(plain.stepper().unknowns_per_contact(), 1);
  (void)plain.step();
  EXPECT_EQ(plain.state().memory.impulse.size(), plain.state().memory.i.size());
  EXPECT_TRUE(plain.state().bodies.id.empty());
  EXPECT_FALSE(plain.state().traffic);
  EXPECT_FALSE(plain.state().left);
  EXPECT_FALSE(plain.state().cell);
  EXPECT_FALSE(plain.take_snapshot().cell);
  EXPECT_TRUE(plain.take_snapshot().id.empty());
  EXPECT_TRUE(plain.take_snapshot().mass.empty());
}

TEST(Periodic, PairAcrossTheSeamCollidesAsInside) {
  const auto end = [](double shift) {
    const TemporaryFolder folder;
    Scene scene = scene_of({{-0.6 + shift, 0, 1, 1}, {0.6 + shift, 0.2, 1, -1}}, folder);
    scene.periodic_x = PeriodicX{-5, 5};
    scene.effects.friction = Friction{0.3, 0.3};
    scene.effects.spin = Spin{};
    add_stage(scene, 1, 0.01);
    Simulation simulation(scene);
    while (!simulation.finished()) (void)simulation.step();
    return simulation.state().bodies;
  };
  const Bodies inside = end(0), seam = end(5);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(seam.x[k] - inside.x[k], 5, 1e-9);
    EXPECT_NEAR(seam.v_z[k], inside.v_z[k], 1e-9);
  }
  EXPECT_NE(inside.v_z[0], 0);
}

TEST(Detection, FindsWhatBruteForceFinds) {
  RandomStream random(7, "test");
  for (const bool periodic : {false, true}) {
    Bodies bodies;
    std::vector<double> v_x, v_z;
    for (int k = 0; k < 300; ++k) {
      add_body(bodies, random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(0.1, 0.6));
      const double speed = k % 50 == 0 ? 60 : 1;
      v_x.push_back(random.uniform(-speed, speed));
      v_z.push_back(random.uniform(-speed, speed));
    }
    const std::vector<Shape> shapes{Segment{{-7, -7}, {7, -6}}, FixedDisc{{1, 1}, 2}, Container{{0, 0}, 12}};
    const std::vector<ShapeStep> still(3);
    DetectionInput input{shapes, still, 0.05, 0.02, {}};
    if (periodic) input.period = {-8, 16};
    ContactDetection detection;
    const auto found = detection.find(bodies, v_x, v_z, input);
    // Every pair that its own approach closes within the step must be there.
    std::size_t needed = 0;
    const auto expect_listed = [&](int i, int j) {
      Candidate pair{i, j, 0, 0, 0, 0, 0};
      double n_x = 0, n_z = 0;
      const double gap = gap_now(pair, bodies, shapes, input.period, n_x, n_z);
      const double u_x = v_x[i] - (j >= 0 ? v_x[j] : 0), u_z = v_z[i] - (j >= 0 ? v_z[j] : 0);
      if (gap >= 0.02 + 2 * 0.05 * std::max(0.0, -(n_x * u_x + n_z * u_z))) return;
      ++needed;
      EXPECT_TRUE(
          std::any_of(found.begin(), found.end(), [&](const Candidate& c) { return c.i == i && c.j == j; }))
          << i << ' ' << j << " gap " << gap;
    };
    for (int i = 0; i < 300; ++i) {
      for (int j = i + 1; j < 300; ++j) expect_listed(i, j);
      for (int s = 0; s < 3; ++s) expect_listed(i, -1 - s);
    }
    EXPECT_GT(needed, 400u);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
      return a.i != b.i ? a.i < b.i : a.j < b.j;
    }));
  }
}

TEST(Random, StreamsAreFixedForeverAndApart) {
  // Golden: computed once with this code; a change would change every run of every seed.
  RandomStream a(1, "grains/diameter"), b(1, "grains/diameter"), c(1, "grains/position"),
      d(2, "grains/diameter");
  const auto first = a.bits();
  EXPECT_EQ(first, 16353020343593318767u);
  EXPECT_EQ(first, b.bits());
  EXPECT_NE(first, c.bits());
  EXPECT_NE(first, d.bits());
  double sum = 0;
  for (int k = 0; k < 10000; ++k) sum += a.uniform();
  EXPECT_NEAR(sum / 10000, 0.5, 5 * std::sqrt(1.0 / 12 / 10000));
}

TEST(Placement, PeriodShorterThanThreeDiscsIsRefused) {
  const TemporaryFolder folder;
  Scene scene = scene_of({{0, 2}}, folder);
  scene.periodic_x = PeriodicX{-0.75, 0.75};
  EXPECT_THROW(place_grains(scene, scales_of(scene)), InputError);
}

TEST(Placement, ListedNumbersOutOfBoundsAreRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(scales_of(scene_of({{0, 0, 1e308}}, folder)), InputError);
  const Scene far = scene_of({{1e308, 0}, {0, 0}}, folder);
  EXPECT_THROW(scales_of(far), InputError);
}

TEST(Placement, RegionThatIsTooSmallIsRefused) {
  Scene scene = small_drum(10000);
  EXPECT_THROW(place_grains(scene, scales_of(scene)), InputError);
}

}  // namespace
}  // namespace drumlin
