// Rolling resistance: closed forms of one disc, and the local problem against its own conditions.
#include <numbers>

#include "particles/contact/problems.hpp"
#include "particles/contact/residual.hpp"
#include "particles/scene/random.hpp"
#include "tests/effects/drums.hpp"
#include "tests/particles/solving.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

TestScene on_a_floor(double v, double slope_deg, double mu, double mu_r) {
  return on_floor({{0, 0.5, 1, v, 0, 2 * v}})
      .with(Gravity{9.81, -90 + slope_deg}, Friction{mu, mu}, Spin{}, RollingResistance{mu_r, mu_r});
}

TEST(RollingResistance, SlowsARollingDiscByTwoThirdsOfItsShareOfGravity) {
  // m a = -F, J alpha = F r - mu_r m g r with J = m r^2 / 2 and a = r alpha: a = -2/3 mu_r g.
  const double v0 = 1, mu_r = 0.3;
  TestRun run(on_a_floor(v0, 0, 0.8, mu_r).lasting(6, 1e-2));  // it stops at 5
  run.each_step([&] {
    const double expected = std::max(0.0, v0 - 2.0 / 3 * mu_r * run.time());
    ASSERT_NEAR(run.bodies().v_x[0], expected, 1e-9);
    ASSERT_NEAR(run.bodies().spin[0], 2 * expected, 1e-9);
  });
}

TEST(RollingResistance, HoldsADiscOnASlopeBelowItsCoefficient) {
  // About the contact: m g sin r against at most mu_r m g cos r.
  EXPECT_NEAR(
      bodies_at_end(on_a_floor(0, 20, 1, std::tan(std::numbers::pi / 9) + 1e-3).lasting(2, 1e-2)).v_x[0], 0,
      1e-9);
}

TEST(RollingResistance, LetsADiscRollOnASteeperSlope) {
  // a = 2/3 g (sin - mu_r cos); friction (tan - mu_r)/3 + mu_r = 0.19 of the load is there.
  const double slope = std::numbers::pi / 9, mu_r = 0.1;
  EXPECT_NEAR(bodies_at_end(on_a_floor(0, 20, 0.8, mu_r).lasting(2, 1e-2)).v_x[0] / 2,
              2.0 / 3 * (std::sin(slope) - mu_r * std::cos(slope)), 1e-8);
}

TEST(RollingResistance, HoldsASpinningDiscBetweenTurningWalls) {
  // Without gravity nothing presses, without load nothing resists: the spin stays.
  EXPECT_EQ(bodies_at_end(scene_of({{0, 0.5, 1, 0, 0, 3}})
                              .between({floor_wall()})
                              .with(Friction{0.5, 0.5}, Spin{}, RollingResistance{0.5, 0.5})
                              .lasting(1, 1e-2))
                .spin[0],
            3);
}

TEST(RollingResistance, ReckonsTheTurningOfAWallIn) {
  // A disc that lies on a turning drum, at the drum's velocity, stays where it is on the wall, neither
  // sliding nor rolling, until the slope there reaches mu_r.
  const double spin = 0.05, duration = 5;
  const Bodies end = bodies_at_end(scene_of({{0, -9.5, 1, -9.5 * spin, 0, spin}})
                                       .between({drum_wall(10)})
                                       .with(Gravity{}, Friction{2, 2}, Spin{}, RollingResistance{1, 1})
                                       .lasting(duration, 1e-2)
                                       .moving("drum", turning(spin)));
  // An angle of 0.25 rad, where tan = 0.255 < 1; first order in the step.
  EXPECT_NEAR(end.spin[0], spin, 1e-6);
  EXPECT_NEAR(end.x[0], -9.5 * std::sin(spin * duration), 1e-2);
}

TEST(RollingResistance, OfZeroStrengthIsNone) {
  Scene plain = turning_drum(30), weak = plain;
  plain.solver.tolerance = weak.solver.tolerance = 1e-10;
  plain.solver.max_sweeps = weak.solver.max_sweeps = 5000;
  plain.stages[0].duration_s = weak.stages[0].duration_s = 0.05;
  weak.effects.rolling_resistance = RollingResistance{0, 0};
  // Contacts are solved in another order: alike up to the tolerance and what impacts make of it.
  expect_near(bodies_at_end(plain), bodies_at_end(weak), 1e-6);
}

/// W_aa by unit impulses, against the block that the sweep uses.
template <class Delassus>
void expect_block_is_the_response(const Delassus& W) {
  for (int a = 0; a < W.contacts(); ++a) {
    const LocalMatrix block = W.block(a).matrix;
    const double expected[3][3] = {
        {block.nn, block.nt, 0}, {block.nt, block.tt, block.tr}, {0, block.tr, block.rr}};
    for (int c = 0; c < Delassus::dim; ++c) {
      typename Delassus::State state;
      W.rest(state);
      typename Delassus::Impulse unit{};
      unit[c] = 1;
      W.push(state, a, unit);
      const auto u = W.relative_velocity(state, a);
      for (int row = 0; row < Delassus::dim; ++row) EXPECT_NEAR(u[row], expected[row][c], 1e-12) << row << c;
    }
  }
}

TEST(RollingContact, BlockIsTheResponseToUnitImpulses) {
  RollingProblem::Delassus W;
  W.inverse_mass = {1, 0.3, 7, 0, 0};  // three grains, the fixed body, one driven wall
  W.driven = {{0.6, 0.8, 2.5}};
  W.add(0, 1, 0.8, -0.6, 0.3);
  W.add(1, 2, 0, 1, 0.8);
  W.add(2, 3, 1, 0, 1);
  W.add(0, 4, 0, -1, 1);
  expect_block_is_the_response(W);
  CoulombSpinProblem::Delassus V;
  V.inverse_mass = {1, 0, 0};
  V.driven = {{0.6, 0.8, 2.5}};
  V.add(0, 2, 0, -1);
  expect_block_is_the_response(V);
}

TEST(RollingContact, SolversReachTheJudgeOfTheThreefoldLaw) {
  // A row of unequal discs pressed onto a floor and onto each other.
  RollingProblem problem;
  RandomStream random(3, "row");
  auto& W = problem.W;
  for (int b = 0; b < 8; ++b) W.inverse_mass.push_back(random.uniform(0.2, 5));
  W.inverse_mass.push_back(0);
  const auto add = [&](int i, int j, double n_x, double n_z, double radius_ratio) {
    W.add(i, j, n_x, n_z, radius_ratio);
    problem.q.insert(problem.q.end(), {random.uniform(-1, 0), random.uniform(-1, 1), random.uniform(-1, 1)});
    problem.mu.insert(problem.mu.end(), {0.4, 0.2});
  };
  for (int b = 0; b < 8; ++b) add(b, 8, 0, 1, 1);
  for (int b = 0; b < 7; ++b) add(b + 1, b, 1, 0, random.uniform(0.2, 0.8));
  for (const char* name : {"nlgs", "nncg"}) {
    auto solution = solved_by(name, problem, 1e-10, 5000);
    EXPECT_EQ(solution.report.status, Status::converged) << name;
    // A wrong impulse is seen: the residual is no rubber stamp.
    solution.impulses[2] += 0.1;
    EXPECT_GT(residual_of(problem, solution).rms, 1e-3);
  }
}

}  // namespace
}  // namespace drumlin
