// What past strain adds to the amount of the stress: closed forms. The fit: tests/python/test_bed.py.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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

/// The dilatancy at the end of a path, of which Python takes the same two means.
double felt_dilatancy(const StressPath& path) {
  const auto& [swelling, c_nu, c_psi, lag, creep, own_weight] = *law.amount;
  const auto remembered = [&](double c) { return carried_ln_I(path, c, std::log(1e-6), 0); };
  return swelling * c_nu * c_psi / (c_psi - c_nu) * (remembered(c_psi) - remembered(c_nu));
}

TEST(AmountMemory, AddsNothingInSteadySimpleShear) {
  for (const double I : {1e-5, 1e-3, 0.03, 0.5}) {
    const StressPath path = steady_shear(400, 0.01, std::log(I));
    EXPECT_NEAR(felt_dilatancy(path), 0, 1e-12) << I;
    EXPECT_NEAR(carried_lag(path, known_memory), 0, 1e-12) << I;
    EXPECT_EQ(carried_dilatancy(path, 4), 0) << I;
  }
}

TEST(AmountMemory, SwellsAndForgetsWhereTheShearIsSuddenlyFaster) {
  // nu follows with c_nu, the dilatancy that is felt with c_psi: a difference of two exponentials.
  const double from = std::log(1e-4), to = std::log(1e-2), strain = 0.07;
  for (const std::size_t pieces : {1U, 50U}) {
    StressPath path = steady_shear(400, 0.01, from);
    for (std::size_t k = 0; k < pieces; ++k)
      path.steps.push_back({strain / static_cast<double>(pieces), 0, path.axis, to});
    path.ln_I = to;
    const double c_nu = 4, c_psi = 16;
    const double expected = 0.008 * c_nu * c_psi / (c_psi - c_nu) * (to - from) *
                            (std::exp(-2 * c_nu * strain) - std::exp(-2 * c_psi * strain));
    EXPECT_NEAR(felt_dilatancy(path), expected, 1e-12);
    EXPECT_GT(expected, 0);
  }
}

TEST(AmountMemory, IsTheStepwiseSolutionOfItsTwoEquations) {
  // Euler's steps of the equations that a flow solves, with an I that rises and falls.
  const AmountMemory& amount = *law.amount;
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
  EXPECT_NEAR(felt_dilatancy(path), psi, 2e-4);
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

}  // namespace
}  // namespace drumlin::amount_memory
