// Dynamic friction: closed forms of discs that slide, with the error that the sliding speed of a step's
// beginning makes.
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

constexpr double mu_s = 0.6, mu_d = 0.2, speed = 0.5;

/// A disc that cannot turn, at v on a floor in gravity tilted by some degrees.
TestScene block(double v, double slope_deg, double duration, double h) {
  return on_floor({{0, 0.5, 1, v}})
      .with(Gravity{9.81, -90 + slope_deg}, Friction{mu_s, mu_s},
            DynamicFriction{{mu_d, mu_d}, speed / time_s})
      .lasting(duration, h);
}

/// dv/dt = -mu(v), from v0: y = exp(v / speed) obeys dy/dt = -(mu_d y + mu_s - mu_d) / speed.
double sliding(double v0, double t) {
  const double more = (mu_s - mu_d) / mu_d;
  return speed * std::log((std::exp(v0 / speed) + more) * std::exp(-mu_d * t / speed) - more);
}

TEST(DynamicFriction, LetsADiscSlideToRestWithAnErrorOfFirstOrder) {
  const auto missed = [](double h) { return bodies_at_end(block(2, 0, 4, h)).v_x[0] - sliding(2, 4); };
  EXPECT_GT(sliding(2, 4), 0.3);
  EXPECT_LT(std::abs(missed(0.02)), 0.02);
  EXPECT_NEAR(missed(0.04) / missed(0.02), 2, 0.1);
  EXPECT_NEAR(missed(0.02) / missed(0.01), 2, 0.05);
}

TEST(DynamicFriction, StopsADiscWhereItMust) {
  const double stops = speed / mu_d * std::log((mu_d * std::exp(4) + mu_s - mu_d) / mu_s), h = 5e-3;
  TestRun run(block(2, 0, 1.1 * stops, h));
  double rests_at = 0;
  run.each_step([&] {
    if (rests_at == 0 && run.bodies().v_x[0] < 1e-9) rests_at = run.time();
  });
  EXPECT_NEAR(rests_at, stops, 4 * h);
  EXPECT_NEAR(run.bodies().v_x[0], 0, 1e-9);
}

TEST(DynamicFriction, TakesTheSpeedAgainstABelt) {
  TestRun run(block(0, 0, 8, 1e-2).moving("floor", Belt{2 * mm_s}));  // the speeds are the same after 7.34
  run.to_time(3);
  EXPECT_NEAR(run.bodies().v_x[0], 2 - sliding(2, 3), 1e-2);
  run.to_end();
  EXPECT_NEAR(run.bodies().v_x[0], 2, 1e-8);  // it rides
}

TEST(DynamicFriction, LetsADiscOnASlopeRestOrSlideAsItBegins) {
  // tan 20 = 0.364 lies between the coefficients: mu is as much at v = speed ln(0.4 / 0.164) = 0.45.
  EXPECT_NEAR(bodies_at_end(block(0, 20, 2, 1e-2)).v_x[0], 0, 1e-9);
  EXPECT_NEAR(bodies_at_end(block(0.40, 20, 20, 1e-2)).v_x[0], 0, 1e-9);
  EXPECT_GT(bodies_at_end(block(0.50, 20, 20, 1e-2)).v_x[0], 1);
}

TEST(DynamicFriction, OfAnImpactIsThatOfItsSpeed) {
  const double e = 0.5, v_t = 1, v_n = 0.3;
  Scene scene =
      scene_of({{0, 0.55, 1, v_t, -v_n}})
          .between({floor_wall()})
          .with(Friction{mu_s, mu_s}, Restitution{e, e}, DynamicFriction{{mu_d, mu_d}, speed / time_s})
          .lasting(0.5, 1e-2);
  const double mu = mu_d + (mu_s - mu_d) * std::exp(-v_t / speed);
  EXPECT_NEAR(bodies_at_end(scene).v_x[0], v_t - mu * (1 + e) * v_n, 1e-8);
}

}  // namespace
}  // namespace drumlin
