// The cell without walls: periodic in x and z, sheared after Lees and Edwards, deformed at given rates,
// pressed.

#include "coupling/core/basics/errors.hpp"
#include "particles/detection/contact_list.hpp"
#include "particles/effects/moving_cell.hpp"
#include "particles/scene/random.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/run_through.hpp"
#include "particles/stepping/stepped_scene.hpp"
#include "tests/effects/drums.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin::cells_test {
using namespace particles;
using namespace test;
namespace {

/// In a cell of so many unit lengths, its lower left corner at the origin.
TestScene in_cell(TestScene scene, double length, double height) {
  scene.periodic_x = PeriodicX{0, length};
  scene.periodic_z = PeriodicZ{0, height};
  return scene;
}

CellAxis pressed(double pressure) { return {pressure * pressure_unit, {}}; }
CellAxis strained(double rate) { return {{}, rate / time_s}; }

/// n x n discs, one in the middle of each square of edge `spacing`, at random velocities of mean zero.
TestScene gas(int n, double spacing, double speed) {
  RandomStream random(3, "gas");
  std::vector<Grain> grains;
  double mean_x = 0, mean_z = 0;
  for (int k = 0; k < n * n; ++k) {
    const double v_x = random.uniform(-speed, speed), v_z = random.uniform(-speed, speed);
    grains.push_back({(k % n + 0.5) * spacing, (k / n + 0.5) * spacing, 1, v_x, v_z});
    mean_x += v_x / (n * n), mean_z += v_z / (n * n);
  }
  for (Grain& g : grains) g.v_x -= mean_x, g.v_z -= mean_z;
  return in_cell(scene_of(grains), n * spacing, n * spacing);
}

/// Stress of the contacts of a snapshot: xx, zz, and the force along x on planes across z. Compression > 0.
struct Stress {
  double xx = 0, zz = 0, xz = 0;
};
Stress stress_of(const Snapshot& s) {
  Stress sum;
  for (const SnapshotContact& c : s.contacts) {
    const double n_x = c.normal_x, n_z = c.normal_z, arm = s.radius[c.i] + s.radius[c.j];
    const double f_x = (c.impulse_n * n_x + c.impulse_t * n_z) / s.time_step;
    const double f_z = (c.impulse_n * n_z - c.impulse_t * n_x) / s.time_step;
    sum.xx += arm * n_x * f_x, sum.zz += arm * n_z * f_z, sum.xz -= arm * n_z * f_x;
  }
  const double area = s.period_x * s.cell->height;
  return {sum.xx / area, sum.zz / area, sum.xz / area};
}

TEST(Cell, PairAcrossTheCornerOrTheSeamOfAPeriodCollidesAsInside) {
  const auto end = [](double shift, bool cell) {
    const double up = cell ? shift : 0;
    TestScene scene =
        in_cell(scene_of({{5 - 0.6 + shift, 5 + up, 1, 1}, {5 + 0.6 + shift, 5.2 + up, 1, -1}}), 10, 10);
    if (!cell) scene.periodic_z.reset();
    return bodies_at_end(scene.with(Friction{0.3, 0.3}, Spin{}).lasting(1, 0.01));
  };
  for (const bool cell : {false, true}) {
    const Bodies inside = end(0, cell), across = end(5, cell);
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(across.x[k] - inside.x[k], 5, 1e-9);
      EXPECT_NEAR(across.z[k] - inside.z[k], cell ? 5 : 0, 1e-9);
      EXPECT_NEAR(across.v_z[k], inside.v_z[k], 1e-9);
      EXPECT_NEAR(across.spin[k], inside.spin[k], 1e-9);
    }
    EXPECT_NE(inside.v_z[0], 0);
  }
}

TEST(Cell, ElasticGasKeepsMomentumAndEnergy) {
  TestRun run(gas(6, 1.6, 1).with(Restitution{1, 1}).lasting(6, 0.01));
  const double energy = run.kinetic();
  int impacts = 0;
  run.each_step([&](const StepReport& report) { impacts += report.impacts; });
  EXPECT_GT(impacts, 100);
  expect_near(momentum(run.bodies()), {}, 1e-11);
  EXPECT_NEAR(run.kinetic(), energy, 1e-9 * energy);
}

TEST(Cell, DetectionFindsAllPairsOfAllImages) {
  RandomStream random(7, "cell");
  for (const double offset : {0.0, 1.7, -3.1}) {
    const Period period{-3, 9, 2, 7, offset, 0.3, -0.2, 0.9};
    Bodies bodies;
    for (int k = 0; k < 120; ++k)
      add_body(bodies, random.uniform(-3, 6), random.uniform(2, 9), random.uniform(0.1, 0.5));
    for (int k = 0; k < 120; ++k)
      bodies.v_x[k] = random.uniform(-9, 9), bodies.v_z[k] = random.uniform(-9, 9);
    const double h = 0.02, margin = 0.02;
    ContactDetection detection;
    const auto& found = detection.find(bodies, bodies.v_x, bodies.v_z, {{}, {}, h, margin, period});
    std::size_t needed = 0;
    for (std::int32_t i = 0; i < 120; ++i)
      for (std::int32_t j = i + 1; j < 120; ++j) {
        double gap = 1e9, approach = 0;
        for (int up = -2; up <= 2; ++up)
          for (int right = -3; right <= 3; ++right) {
            const Point shift{right * 9 + up * offset, up * 7.0};
            const double dx = bodies.x[i] - bodies.x[j] - shift.x, dz = bodies.z[i] - bodies.z[j] - shift.z;
            const double apart = std::hypot(dx, dz), here = apart - bodies.radius[i] - bodies.radius[j];
            if (here >= gap) continue;
            gap = here;
            const Point image = period.image_velocity(shift);
            approach = -(dx * (bodies.v_x[i] - bodies.v_x[j] - image.x) +
                         dz * (bodies.v_z[i] - bodies.v_z[j] - image.z)) /
                       apart;
          }
        const auto same = [&](const Candidate& c) { return c.i == i && c.j == j; };
        const auto pair = std::find_if(found.begin(), found.end(), same);
        if (gap < margin + 2 * h * std::max(0.0, approach)) {
          ++needed;
          ASSERT_NE(pair, found.end()) << i << " " << j << " offset " << offset << " gap " << gap;
        }
        if (pair != found.end()) {
          EXPECT_NEAR(pair->gap, gap, 1e-12);
        }
        EXPECT_LE(std::count_if(found.begin(), found.end(), same), 1);
      }
    EXPECT_GT(needed, 100u);
  }
}

TEST(Cell, StrainsGrainsHomogeneouslyAtGivenRates) {
  TestScene scene = in_cell(scene_of({{2, 3}, {6, 8}}), 10, 12).lasting(1, 0.01);
  scene.stages[0].cell = StageCell{strained(0.2), strained(-0.1), {}, 1};
  EndedRun run(scene);
  const double stretch_x = std::pow(1 + 0.01 * 0.2, 100), stretch_z = std::pow(1 - 0.01 * 0.1, 100);
  const auto& state = run.state();
  EXPECT_NEAR(state.cell->length_x, 10 * stretch_x, 1e-9);
  EXPECT_NEAR(state.cell->length_z, 12 * stretch_z, 1e-9);
  EXPECT_NEAR(state.bodies.x[1] - state.bodies.x[0], 4 * stretch_x, 1e-9);  // as images of one grain
  EXPECT_NEAR(state.bodies.z[1] - state.bodies.z[0], 5 * stretch_z, 1e-9);
}

TEST(Cell, ShearedGrainsComeBackWithTheVelocityOfTheImage) {
  // Two grains that move up and down at 1 in the middle of a cell of height 10, sheared at 0.5.
  TestScene scene = in_cell(scene_of({{2, 5, 1, 0, 1}, {25, 5, 1, 0, -1}}), 40, 10).lasting(6, 0.01);
  scene.stages[0].cell = StageCell{{}, {}, 0.5 / time_s, 1};
  EndedRun run(scene);
  const Bodies& b = run.bodies();
  EXPECT_NEAR(b.z[0], 1, 1e-9);     // 5 + 6 - 10
  EXPECT_NEAR(b.v_x[0], -5, 1e-9);  // that of the image below
  EXPECT_NEAR(b.z[1], 9, 1e-9);
  EXPECT_NEAR(b.v_x[1], 5, 1e-9);
  // The image above has moved by 0.5 * 10 * 6 = 30, a period less 10.
  EXPECT_NEAR(run.state().cell->offset, -10, 1e-9);
  // The borders were crossed at t = 5, when it was at 25; from then on the grains moved at -5 and 5.
  EXPECT_NEAR(b.x[0], 2 - 25 - 5 + 40, 1e-9);
  EXPECT_NEAR(b.x[1], 25 + 25 + 5 - 40, 1e-9);
}

TestScene sheared_gas() {
  TestScene scene =
      gas(8, 1.25, 0.5).with(Restitution{0.7, 0.7}, Friction{0.3, 0.3}, Spin{}).lasting(10, 0.01);
  scene.output.energy_ledger = true;
  scene.stages[0].cell = StageCell{{}, {}, 1 / time_s, 1};
  return scene;
}

TEST(Cell, ShearedGasKeepsItsInvariantAndItsProfile) {
  TestRun run(sheared_gas());
  (void)run.step();
  // Momentum of unwrapped grains is conserved: sum m (v_x - shear z) of wrapped ones.
  const auto invariant = [&] {
    const Bodies& b = run.bodies();
    double sum = 0;
    for (std::size_t k = 0; k < b.count(); ++k) sum += weight * (b.v_x[k] - b.z[k]);
    return sum;
  };
  const double before = invariant();
  double zz = 0, zv = 0;
  run.each_step([&] {
    const Bodies& b = run.bodies();
    for (std::size_t k = 0; k < b.count(); ++k)
      zz += (b.z[k] - 5) * (b.z[k] - 5), zv += (b.z[k] - 5) * b.v_x[k];
  });
  EXPECT_NEAR(invariant(), before, 1e-9);
  EXPECT_NEAR(momentum(run.bodies()).z, 0, 1e-10);
  EXPECT_NEAR(zv / zz, 1, 0.05);  // the slope is the shear rate
}

TEST(Cell, ResultsDoNotDependOnAGalileanShift) {
  Scene scene = sheared_gas();
  scene.stages[0].duration_s = 2 * time_s;
  scene.effects.friction.reset(), scene.effects.spin.reset();
  const Simulation at_rest(scene);
  SimulationState state = at_rest.state();
  for (std::size_t b = 0; b < state.bodies.count(); ++b) state.bodies.v_x[b] += 2, state.bodies.v_z[b] += 3;
  EndedRun one(scene), two(scene, state);
  const Bodies &a = one.state().bodies, &b = two.state().bodies;
  const Period period = period_of(*one.state().cell);
  for (std::size_t k = 1; k < a.count(); ++k) {
    const Point d =
        period.nearest(Point{(a.x[k] - a.x[0]) - (b.x[k] - b.x[0]), (a.z[k] - a.z[0]) - (b.z[k] - b.z[0])});
    EXPECT_NEAR(d.x, 0, 1e-6);
    EXPECT_NEAR(d.z, 0, 1e-6);
  }
}

/// A cell of 4 x 4 touching discs under pressures.
TestScene lattice(double p_x, double p_z) {
  std::vector<Grain> grains;
  for (int k = 0; k < 16; ++k) grains.push_back({k % 4 + 0.5, k / 4 + 0.5});
  TestScene scene = in_cell(scene_of(grains), 4, 4).lasting(0.5, 0.01);
  scene.stages[0].snapshots = 1;
  scene.stages[0].cell = StageCell{pressed(p_x), pressed(p_z), {}, 1};
  return scene;
}

TEST(Cell, LatticeCarriesThePressuresOfItsAxes) {
  EndedRun run(lattice(2, 5));
  const Stress stress = stress_of(run.take_snapshot());
  EXPECT_NEAR(stress.xx, 2, 1e-6);
  EXPECT_NEAR(stress.zz, 5, 1e-6);
  EXPECT_NEAR(run.state().cell->length_x, 4, 1e-6);
  EXPECT_NEAR(run.state().cell->length_z, 4, 1e-6);
}

TEST(Cell, AxisUnderPressureFallsWithItsInertia) {
  // No contact, no motion: Q d(rate)/dt = -V p with Q = m L^2 / 12, here for three steps.
  TestScene scene = in_cell(scene_of({{2, 2}, {7, 6}}), 10, 8).lasting(0.03, 0.01);
  scene.stages[0].cell = StageCell{{}, pressed(0.1), {}, 2};
  TestRun run(scene);
  (void)run.step();
  const double inertia = 2 * 2 * weight * 64 / 12;
  EXPECT_NEAR(run.state().cell->rate_z, -0.01 * 80 * 0.1 / inertia, 1e-12);
  EXPECT_EQ(run.state().cell->rate_x, 0);
}

/// 30 discs in a cell that presses them on both axes until they are at rest.
TestScene pressed_to_rest() {
  TestScene scene = in_cell(scene_of(GeneratedGrains{30, 0.8, 1.2, RectangleRegion{{0, 0}, {7, 7}}}), 7, 7)
                        .lasting(100, 0.02);
  scene.stages[0].cell = StageCell{pressed(1), pressed(1), {}, 1};
  scene.stages[0].until = Until{};
  scene.stages[0].until->at_rest = UntilRest{1e-8, 0.5 * time_s};
  return scene;
}

TEST(Cell, PressedGrainsKeepTheirMomentumAgainstTheCellAndComeToRest) {
  // Which image of a grain stands in the cell changes nothing: sum m (v - A (x - x_c)) stays 0. At rest A is
  // 0, and so is the mean velocity. A packing that drifts with its cell is at rest, too.
  for (const double drift : {0.0, 0.5}) {
    const Scene scene = pressed_to_rest();
    SimulationState state = Simulation(scene).state();
    for (double& v : state.bodies.v_x) v += drift;
    TestRun run(scene, std::move(state));
    const auto velocity_against_cell = [&] {
      const auto& [bodies, cell] = std::tie(run.bodies(), *run.state().cell);
      Point sum = momentum(bodies);
      double mass = 0;
      for (std::size_t b = 0; b < bodies.count(); ++b) {
        const double m = 1 / bodies.inverse_mass[b];
        const Point flow =
            period_of(cell).image_velocity({bodies.x[b] - cell.middle_x, bodies.z[b] - cell.middle_z});
        mass += m, sum.x -= m * flow.x, sum.z -= m * flow.z;
      }
      return Point{sum.x / mass, sum.z / mass};
    };
    run.each_step([&] {
      if (drift == 0) expect_near(velocity_against_cell(), {}, 1e-12);
    });
    EXPECT_EQ(run.state().ends.at(0).by, EndedBy::rest);
    EXPECT_NEAR(velocity_against_cell().z, 0, 1e-12);
    if (drift == 0) expect_near(momentum(run.bodies()), {}, 1e-3);
  }
}

/// Steps of 100 discs that miss a tolerance while a cell presses them, or while they fall on a floor.
int missed_steps(const std::string& solver, double mu, bool by_cell) {
  TestScene scene = scene_of(GeneratedGrains{100, 0.8, 1.2, RectangleRegion{{0, 0.1}, {13, 13}}});
  scene.with(Friction{mu, mu}, Spin{}).lasting(12, 0.05);
  if (by_cell) {
    scene = in_cell(scene, 13, 13.2);
    scene.stages[0].cell = StageCell{pressed(1), pressed(1), {}, 1};
  } else {
    scene.between({segment("floor", {0, 0}, {13, 0})}).with(Gravity{});
    scene.periodic_x = PeriodicX{0, 13};
  }
  scene.solver.name = solver;
  TestRun run(scene);
  int missed = 0;
  run.each_step([&](const StepReport& report) { missed += !is_converged(report); });
  return missed;
}

// None is right. In a step of some hundred sweeps swing for ever, from any start that was tried
// (docs/decisions.md); the hard cases hold the expectation.
TEST(SteepFriction, MissesAtMostAStepInAHundred) {
  int missed = 0, runs = 0;
  for (const std::string solver : {"accelerated", "nlgs"})
    for (const double mu : {2.0, 10.0, 100.0})
      for (const bool pressed : {true, false}) ++runs, missed += missed_steps(solver, mu, pressed);
  EXPECT_LE(missed, runs * 240 / 100);
}

TEST(Cell, BooksItsWork) {
  Scene scene = sheared_gas();
  scene.stages[0].cell->zz = pressed(1);
  EndedRun run(scene);
  const EnergyLedger& ledger = *run.state().energy;
  ASSERT_TRUE(ledger.cell);
  EXPECT_GT(*ledger.cell, 0);
  EXPECT_LT(ledger.friction, 0);
  EXPECT_EQ(ledger.walls, 0);
  EXPECT_NEAR(closing_error(ledger), 0, 1e-9 * ledger.turnover);
}

TEST(Cell, AnotherShearRateHoldsFromTheNextStep) {
  const auto stepped = [](const char* name) {
    const Scene scene = read_scene(data_folder() / "scenes" / name);
    return SteppedScene(scene, std::make_unique<Simulation>(scene));
  };
  SteppedScene cell = stepped("plane-shear-cell.toml");
  (void)cell.step();
  EXPECT_EQ(cell.simulation().state().cell->shear, 0);
  cell.set_shear_rate(0.01);
  (void)cell.step();
  EXPECT_NEAR(cell.simulation().state().cell->shear, 0.01, 1e-15);
  EXPECT_THROW(stepped("drum-smoke.toml").set_shear_rate(0.01), InputError);
}

TEST(Cell, AbsentItIsNoState) {
  TestScene scene = gas(4, 1.5, 1).lasting(0.05, 0.01);
  Simulation still(scene);
  EXPECT_FALSE(still.state().cell);  // it stands still
  EXPECT_TRUE(still.take_snapshot().cell);
  scene.periodic_z.reset();
  EXPECT_FALSE(Simulation(scene).take_snapshot().cell);
}

}  // namespace
}  // namespace drumlin::cells_test
