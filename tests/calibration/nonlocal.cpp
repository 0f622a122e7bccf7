#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coupling/calibration/memory_fit.hpp"
#include "coupling/calibration/nonlocal_fit.hpp"
#include "coupling/core/basics/errors.hpp"
#include "tests/calibration/remembering_drum.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
namespace {

using namespace drumlin::coupling;
using testing::moving_drum;
using testing::RememberingDrum;

/// mu_loc(I) = 0.31 + 0.011 ln I as a table.
FormCurve known_amount_table() {
  FrictionForm form{.kind = FormKind::table, .knots = {1e-7, 1e-5, 1e-3, 1e-1}};
  const double growth = 0.011 * std::log(100);
  return {form, {0.31 + 0.011 * std::log(1e-7), growth, growth, growth}};
}

constexpr double known_A = 0.6, known_mu_s = 0.25;

/// Points that obey the law, scattered over I, lap g/g and ten sectors.
FluidityOfRun obeying_points(double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::uniform_real_distribution<double> share(0, 1);
  const FormCurve amount = known_amount_table();
  FluidityOfRun run{"run", {}};
  for (int i = 0; i < 300; ++i) {
    FluidityPoint point;
    point.sector = i % 10;
    point.I = std::pow(10, -5 + 4 * share(random));
    point.curvature = 0.1 * share(random);
    point.mu = std::max(amount.at(point.I).value, known_mu_s) - known_A * known_A * point.curvature +
               noise * normal(random);
    run.points.push_back(point);
  }
  return run;
}

TEST(NonlocalFit, KnownLengthAndThresholdComeBack) {
  const FluidityOfRun run = obeying_points(0, 1);
  const NonlocalFit fit = fit_nonlocal({&run, 1}, known_amount_table());
  EXPECT_NEAR(fit.law.mu_s, known_mu_s, 0.002);  // the step of the thresholds
  EXPECT_NEAR(fit.law.amplitude, known_A, 0.02);
  EXPECT_LT(fit.rms_bed, 2e-3);
  EXPECT_GT(fit.local_rms_bed, 5 * fit.rms_bed);
}

TEST(NonlocalFit, NoisyPointsGiveThemWithinTheirIntervals) {
  int inside = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const FluidityOfRun run = obeying_points(0.01, seed);
    const NonlocalFit fit = fit_nonlocal({&run, 1}, known_amount_table());
    inside += std::abs(fit.law.amplitude - known_A) <= fit.law.amplitude_ci99.value() ? 1 : 0;
    inside += std::abs(fit.law.mu_s - known_mu_s) <= fit.law.mu_s_ci99.value() + 0.002 ? 1 : 0;
  }
  EXPECT_GE(inside, 11);
}

TEST(NonlocalFit, PointsThatCreepByTheirIAloneAskForNoThreshold) {
  FluidityOfRun run = obeying_points(0, 3);
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 0.01);
  for (FluidityPoint& point : run.points) point.mu = known_amount_table().at(point.I).value + noise(random);
  const NonlocalFit fit = fit_nonlocal({&run, 1}, known_amount_table());
  ASSERT_FALSE(fit.untold.empty());
  expect_has(fit.untold[0], "the runs do not require one");
}

TEST(NonlocalFit, CurvatureOfExponentialDecayIsOneOverItsLengthSquared) {
  const RememberingDrum drum{.half_chord = 1e4};  // layers
  FieldMap map = moving_drum(drum);
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {  // stress of mu = 0.25 along layers
    const double p = map.field("sigma_xx").value[node];
    for (MapField& field : map.fields)
      if (field.name == "sigma_xz" || field.name == "sigma_zx") field.value[node] = 0.25 * p;
  }
  const auto points = fluidity_points(PathFields(map, {.smoothing = 0.3}));
  ASSERT_GT(points.size(), 100U);
  for (const FluidityPoint& point : points) {
    EXPECT_NEAR(point.mu, 0.25, 1e-9);
    // Smoothing takes one side alone near the edge of what speaks: 0.1 %.
    EXPECT_NEAR(point.curvature, 1 / (drum.decay * drum.decay), 1e-4) << point.x << " " << point.z;
  }
}

TEST(NonlocalFit, RunsWithoutABedAreRefused) {
  FluidityOfRun run = obeying_points(0, 5);
  for (FluidityPoint& point : run.points) point.I = 0.01;
  EXPECT_THROW((void)fit_nonlocal({&run, 1}, known_amount_table()), InputError);
}

}  // namespace
}  // namespace drumlin
