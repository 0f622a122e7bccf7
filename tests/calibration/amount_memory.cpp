// What past strain adds to the amount of the stress: its closed forms, and its recovery from paths that obey
// it.
#include "coupling/calibration/amount_memory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/law/memory_law.hpp"
#include "remembering_drum.hpp"

namespace drumlin::amount_memory {
using namespace coupling;
using namespace testing;
namespace {

const MemoryLaw law{.c = 6,
                    .m = 0.9,
                    .chi_deg = 0.6 * 180 / std::numbers::pi,
                    .c_rho = 100,
                    .I_low = 1e-2,
                    .I_high = 1e-1,
                    .mu = {{1e-6, 1}, {0.31 + 0.011 * std::log(1e-6), 0.31}},
                    .amount = AmountMemory{.swelling = 0.008,
                                           .c_nu = 4,
                                           .c_psi = 16,
                                           .lag = 0.05,
                                           .creep = Creep{.slope = 0.015, .ratio = 0.05}}};

TEST(AmountMemory, AddsNothingInSteadySimpleShear) {
  for (const double I : {1e-5, 1e-3, 0.03, 0.5})
    EXPECT_NEAR(added_amount(steady_shear(400, 0.01, std::log(I)), law), 0, 1e-12) << I;
}

TEST(AmountMemory, SwellsAndForgetsWhereTheShearIsSuddenlyFaster) {
  // nu follows with c_nu, the dilatancy that is felt with c_psi: a difference of two exponentials.
  const double from = std::log(1e-4), to = std::log(1e-2), strain = 0.07;
  MemoryLaw swelling = law;
  swelling.amount->lag = 0;
  for (const std::size_t pieces : {1U, 50U}) {
    StressPath path = steady_shear(400, 0.01, from);
    for (std::size_t k = 0; k < pieces; ++k)
      path.steps.push_back({strain / static_cast<double>(pieces), 0, path.axis, to});
    path.ln_I = to;
    const double c_nu = 4, c_psi = 16;
    const double expected = 0.008 * c_nu * c_psi / (c_psi - c_nu) * (to - from) *
                            (std::exp(-2 * c_nu * strain) - std::exp(-2 * c_psi * strain));
    EXPECT_NEAR(added_amount(path, swelling), expected, 1e-12);
    EXPECT_GT(expected, 0);
  }
}

TEST(AmountMemory, IsTheStepwiseSolutionOfItsTwoEquations) {
  // Euler's steps of the equations that a flow solves, with an I that rises and falls.
  const AmountMemory& amount = *law.amount;
  MemoryLaw swelling = law;
  swelling.amount->lag = 0;
  StressPath path = steady_shear(1, 0, std::log(1e-3));
  const double strain = 1e-4;
  double L = std::log(1e-3), psi = 0;
  for (int k = 0; k < 4000; ++k) {
    const double ln_I = std::log(1e-3) + 2 * std::sin(k * 2e-3);
    path.steps.push_back({strain, 0, path.axis, ln_I});
    const double target = dilatancy_target(amount, ln_I, L);
    psi += 2 * amount.c_psi * strain * (target - psi);
    L += 2 * amount.c_nu * strain * (ln_I - L);
  }
  EXPECT_NEAR(added_amount(path, swelling), psi, 2e-4);
  EXPECT_GT(std::abs(psi), 0.01);
}

TEST(AmountMemory, StaysWithinHalfOfTheFriction) {
  const AmountMemory& amount = *law.amount;
  EXPECT_EQ(added_friction(amount, 0.2, 0, 0), 0);
  EXPECT_NEAR(added_friction(amount, 0.2, 0.01, 0.1), 0.01 - 0.05 * 0.1, 1e-15);
  EXPECT_EQ(added_friction(amount, 0.2, 5, 0), 0.1);
  EXPECT_EQ(added_friction(amount, 0.2, -5, 0), -0.1);
  EXPECT_EQ(remembered_ln_I(law, 1e-9), std::log(1e-6));
}

TEST(AmountMemory, LagIsTheSameSeenFromTheOtherSide) {
  // A mirror turns the spin's sign and conjugates the tensors.
  const std::complex<double> n(0.2, 0.8), A(0.5, 0.3);
  EXPECT_NEAR(axes_lag(law, 1, n, A, 1e-4), axes_lag(law, -1, std::conj(n), std::conj(A), 1e-4), 1e-15);
}

TEST(AmountMemory, CreepTakesOffWhatLittleShearPerTurnLacks) {
  const Creep creep{.slope = 0.02, .ratio = 0.05};
  EXPECT_EQ(creep_friction(creep, 1, 0), 0);      // no turn
  EXPECT_EQ(creep_friction(creep, 1, 1), 0);      // simple shear
  EXPECT_EQ(creep_friction(creep, 0.05, -1), 0);  // where it begins
  EXPECT_NEAR(creep_friction(creep, 0.005, -1), -0.02 * std::log(10), 1e-15);
  // The same at any speed.
  EXPECT_NEAR(creep_friction(creep, 0.05, -10), creep_friction(creep, 0.005, -1), 1e-15);
}

/// Paths of a drum whose amount is that of `law`.
PathsOfRun remembering_paths(double surface_speed, double own_weight = 0) {
  const FieldMap map = remembering_drum({.surface_speed = surface_speed});
  PathsOfRun run{"drum", stress_paths(PathFields(map, {.smoothing = 0.3})), {}};
  add_own_weight(run.paths, own_weight);
  for (StressPath& path : run.paths) {
    path.stress = Deviator(known_amount(std::exp(path.ln_I)) + added_amount(path, law), 0);
    run.amounts.push_back(known_amount(std::exp(path.ln_I)));
  }
  return run;
}

CalibratedLaw without_memory(const PathsOfRun& run) {
  std::vector<FrictionPoint> points;
  std::vector<double> I;
  for (const StressPath& path : run.paths) {
    points.push_back({.I = std::exp(path.ln_I), .mu = std::abs(path.stress)});
    I.push_back(points.back().I);
  }
  return calibrated({points}, {.kind = FormKind::table, .knots = table_knots(I)}, 0);
}

class AmountFitOf : public ::testing::TestWithParam<double> {};

TEST_P(AmountFitOf, KnownCoefficientsComeBackAndPredictAnotherSpeed) {
  const double own_weight = GetParam();
  const PathsOfRun run = remembering_paths(1.5, own_weight), other = remembering_paths(2.5, own_weight);
  const CalibratedLaw alone = without_memory(run);
  MemoryLaw axes = law;
  axes.amount.reset();
  const AmountFit fit = fit_amount({&run, 1}, {&other, 1}, axes, alone, own_weight);
  EXPECT_EQ(fit.law.own_weight, own_weight);
  EXPECT_EQ(fit.law.c_nu, 4);
  EXPECT_EQ(fit.law.c_psi, 16);
  EXPECT_NEAR(fit.law.swelling, 0.008, 2e-4);
  EXPECT_NEAR(fit.law.lag, 0.05, 2e-3);
  ASSERT_TRUE(fit.law.creep);
  EXPECT_EQ(fit.law.creep->ratio, 0.05);
  EXPECT_NEAR(fit.law.creep->slope, 0.015, 1e-3);
  EXPECT_NEAR(fit.table.curve().at(1e-4).value, known_amount(1e-4), 1e-3);
  ASSERT_EQ(fit.predictions.size(), 1U);
  EXPECT_LT(fit.predictions[0].bed, 0.2 * fit.predictions[0].bed_alone);
  EXPECT_LT(fit.predictions[0].flow, 0.2 * fit.predictions[0].flow_alone);
}
INSTANTIATE_TEST_SUITE_P(OwnWeight, AmountFitOf, ::testing::Values(0.0, 3.0));

TEST(AmountMemory, OwnWeightEntersIAndTheEndOfTheTable) {
  MemoryLaw weighed = law;
  weighed.amount->own_weight = 4;
  EXPECT_DOUBLE_EQ(inertial_number(law, 0.3, 5), 0.6 / std::sqrt(5));
  EXPECT_DOUBLE_EQ(inertial_number(weighed, 0.3, 5), 0.2);
  const double end = law.mu.I.back();
  EXPECT_NEAR(memory_friction(law).friction(end).mu, memory_friction(weighed).friction(end).mu, 1e-15);
  EXPECT_GT(memory_friction(weighed).friction(4 * end).mu, memory_friction(law).friction(4 * end).mu + 1e-3);
}

TEST(StressPaths, OwnWeightLessensIWhereThePressureIsSmall) {
  const FieldMap map = remembering_drum({});
  const std::vector<StressPath> plain = stress_paths(PathFields(map, {.smoothing = 0.3}));
  std::vector<StressPath> weighed = plain;
  add_own_weight(weighed, 2);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_NEAR(std::exp(2 * (weighed[i].ln_I - plain[i].ln_I)), plain[i].p / (plain[i].p + 2), 1e-12);
    const PathStep &before = plain[i].steps.front(), &after = weighed[i].steps.front();
    EXPECT_NEAR(std::exp(2 * (after.ln_I - before.ln_I)), before.p / (before.p + 2), 1e-12);
  }
}

TEST(AmountFit, FindsNothingWhereTheAmountFollowsI) {
  PathsOfRun run = remembering_paths(1.5);
  for (std::size_t i = 0; i < run.paths.size(); ++i) run.paths[i].stress = run.amounts[i];
  MemoryLaw axes = law;
  axes.amount.reset();
  const AmountFit fit = fit_amount({&run, 1}, {}, axes, without_memory(run));
  EXPECT_NEAR(fit.law.swelling, 0, 1e-4);
  EXPECT_LT(fit.law.creep.value_or(Creep{}).slope, 1e-3);
  EXPECT_NEAR(fit.law.lag, 0, 1e-3);
}

}  // namespace
}  // namespace drumlin::amount_memory
