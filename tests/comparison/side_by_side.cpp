#include <gtest/gtest.h>

#include <algorithm>

#include "coupling/comparison/comparison.hpp"
#include "coupling/comparison/targets.hpp"
#include "coupling/core/basics/errors.hpp"
#include "tests/comparison/example.hpp"
#include "tests/support/says.hpp"

namespace drumlin::side_by_side {
using namespace coupling;
namespace {

using namespace testing;
const Target& target(const Comparison& comparison, const std::string& quantity, const std::string& zone) {
  for (const auto& candidate : comparison.targets)
    if (candidate.quantity == quantity && candidate.zone == zone) return candidate;
  throw std::runtime_error(quantity);
}

TEST(Comparison, OfARunWithItselfMeetsEveryTargetThatIsMeasured) {
  const auto comparison = compare(example_side(), example_side());
  ASSERT_EQ(comparison.targets.size(), 11u);
  for (const auto& one : comparison.targets) {
    EXPECT_EQ(one.outcome, Outcome::met) << one.quantity << " " << one.zone;
    EXPECT_EQ(one.value, 0) << one.quantity;
  }
}

TEST(Comparison, ScalarTargetsTurnAtTheirLimits) {
  const auto outcome = [](const std::string& name, double by) {
    auto continuum = continuum_side();
    for (auto& entry : continuum.scalars.scalars)
      if (entry.name == name) entry.value += by;
    return target(compare(example_side(), continuum), name, "").outcome;
  };
  EXPECT_EQ(outcome("theta_deg", -0.99), Outcome::met);
  EXPECT_EQ(outcome("theta_deg", -1.01), Outcome::missed);
  EXPECT_EQ(outcome("Q", 0.0099 * 21.8), Outcome::met);
  EXPECT_EQ(outcome("Q", 0.0101 * 21.8), Outcome::missed);
  EXPECT_EQ(outcome("H", 1.99), Outcome::met);
  EXPECT_EQ(outcome("H", 2.01), Outcome::missed);
  EXPECT_EQ(outcome("lambda", 0.149 * 3.5), Outcome::met);
  EXPECT_EQ(outcome("lambda", 0.151 * 3.5), Outcome::missed);
}

TEST(Comparison, FieldTargetsTurnAtTheirLimits) {
  const auto outcome = [](const std::string& quantity, const std::string& zone, const std::string& column,
                          double factor) {
    const auto continuum = scaled(continuum_side(), column, factor);
    return target(compare(example_side(), continuum), quantity, zone).outcome;
  };
  const auto turns_at = [&](const std::string& quantity, const std::string& zone, double limit) {
    EXPECT_EQ(outcome(quantity, zone, quantity, 1 + 0.99 * limit), Outcome::met) << quantity;
    EXPECT_EQ(outcome(quantity, zone, quantity, 1 - 1.01 * limit), Outcome::missed) << quantity;
  };
  turns_at("sigma_zz", "all", 0.05);
  turns_at("sigma_xz", "flowing", 0.05);
  turns_at("sigma_xz", "static", 0.15);
  turns_at("sigma_xx", "all", 0.15);
  turns_at("v_x", "flowing", 0.20);
  EXPECT_EQ(outcome("log10_shear_rate", "static", "shear_rate", std::pow(10, 0.29)), Outcome::met);
  EXPECT_EQ(outcome("log10_shear_rate", "static", "shear_rate", std::pow(10, -0.31)), Outcome::missed);
}

TEST(Comparison, ALimitNarrowerThanTheParticlesIntervalIsJudgedByTheNoiseFloor) {
  const auto judged = [](double ci99, double by) {
    ComparedSide particles = example_side();
    auto continuum = continuum_side();
    for (auto& entry : particles.scalars.scalars)
      if (entry.name == "Q") entry.ci99 = ci99 * entry.value;
    for (auto& entry : continuum.scalars.scalars)
      if (entry.name == "Q") entry.value *= 1 + by;
    return target(compare(particles, continuum), "Q", "");
  };
  const Target within = judged(0.04, 0.03), beyond = judged(0.04, -0.05), known = judged(0.009, 0.03);
  EXPECT_EQ(within.outcome, Outcome::met);
  EXPECT_EQ(within.judged_by, JudgedBy::noise_floor);
  EXPECT_NEAR(within.noise_floor, 0.04, 1e-12);
  EXPECT_EQ(within.limit, 0.01);
  EXPECT_EQ(beyond.outcome, Outcome::missed);
  EXPECT_EQ(beyond.judged_by, JudgedBy::noise_floor);
  EXPECT_EQ(known.outcome, Outcome::missed);
  EXPECT_EQ(known.judged_by, JudgedBy::limit);
  // Another run that lies farther off widens the floor, one that lies nearer does not narrow it.
  std::vector<Target> targets{beyond}, other{beyond};
  other[0].value = 0.02;
  judge_by_floor(targets, other);
  EXPECT_EQ(targets[0].outcome, Outcome::missed);
  other[0].value = 0.06;
  judge_by_floor(targets, other);
  EXPECT_EQ(targets[0].outcome, Outcome::met);
  EXPECT_NEAR(targets[0].noise_floor, 0.06, 1e-12);
}

TEST(Comparison, FieldsOfNoisyParticlesAreJudgedByTheirNoiseFloor) {
  ComparedSide particles = example_side();
  auto& noisy = column_of(particles.profiles, "sigma_zz");
  for (std::size_t l = 0; l < noisy.ci99.size(); ++l) noisy.ci99[l] = 0.12 * std::abs(noisy.value[l]);
  const auto found_at = [&](double factor) {
    return target(compare(particles, scaled(continuum_side(), "sigma_zz", factor)), "sigma_zz", "all");
  };
  const Target found = found_at(1.08);
  EXPECT_EQ(found.outcome, Outcome::met);
  EXPECT_EQ(found.judged_by, JudgedBy::noise_floor);
  EXPECT_NEAR(found.noise_floor, 0.12, 1e-12);
  EXPECT_EQ(found_at(1.13).outcome, Outcome::missed);
}

TEST(Comparison, LayersThatTheContinuumLeavesUndefinedMissTheTarget) {
  auto continuum = continuum_side();
  column_of(continuum.profiles, "shear_rate").value[30] = -1e-3;
  const auto comparison = compare(example_side(), continuum);
  EXPECT_EQ(target(comparison, "log10_shear_rate", "static").outcome, Outcome::missed);
  expect_has(target(comparison, "log10_shear_rate", "static").remark, "1 of 42");
}

TEST(Comparison, WhatWasNotComputedIsNeitherMetNorMissed) {
  auto continuum = continuum_side();
  continuum.scalars.scalars[0].value = std::numeric_limits<double>::quiet_NaN();
  const auto comparison = compare(example_side(), continuum);
  EXPECT_EQ(target(comparison, "theta_deg", "").outcome, Outcome::not_measured);
  EXPECT_FALSE(target(comparison, "theta_deg", "").remark.empty());
}

TEST(Comparison, ShearRateAndInterfaceAreReadOffTheProfileWhenNotReported) {
  const auto comparison = compare(example_side(), example_side());
  EXPECT_NEAR(scalar_of(comparison, "shear_rate", &ScalarPair::continuum), example_rate, 1e-9);
  EXPECT_GT(scalar_of(comparison, "I_th", &ScalarPair::continuum), 0);
  EXPECT_TRUE(std::isnan(scalar_of(comparison, "dv_over_shear", &ScalarPair::continuum)));
}

TEST(Comparison, PaperNumbersDoNotFitOneLinearLayer) {
  EXPECT_NEAR(linear_layer_share(0.15, 14.6, 21.8), 0.59, 0.005);  // the paper's own at 6 rpm
  EXPECT_DOUBLE_EQ(linear_layer_share(0.2, 10, 8), 1);             // nu gammadot H^2/2 at nu = 0.8
}

TEST(SameDrum, MixedDrumsSpeedsUnitsAndSizesAreAllNamedAtOnce) {
  auto other = example_side();
  other.profiles.header = header_from({{"rotation", "0.0192"},
                                       {"drum_radius", "30"},
                                       {"diameter_m", "0.001"},
                                       {"reduced", "true"},
                                       {"position", "9"}});
  try {
    compare(example_side(), other);
    FAIL() << "mixed drums were compared";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 5u);
    for (const auto* key : {"rotation", "drum_radius", "diameter_m", "reduced"})
      expect_has(error.what(), key);
  }
}

TEST(SameDrum, EachDifferenceAloneIsRefusedAndSoIsSilence) {
  for (const auto& [key, value] : std::map<std::string, std::string>{
           {"rotation", "0.0117"}, {"drum_radius", "68.5"}, {"diameter_m", "0.00331"}, {"reduced", "true"}}) {
    auto other = example_side();
    set_entry(other.profiles.header, key, value);
    EXPECT_THROW(compare(example_side(), other), InputError) << key;
    erase_entry(other.profiles.header, key);
    EXPECT_THROW(compare(example_side(), other), InputError) << key;
    auto silent = example_side();
    erase_entry(silent.profiles.header, key);
    EXPECT_THROW(compare(silent, other), InputError) << key << ": neither side says it";
  }
}

}  // namespace
}  // namespace drumlin::side_by_side
