#include "coupling/calibration/robust_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "coupling/calibration/calibrated_law.hpp"
#include "coupling/calibration/calibration.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/law/ill_posed.hpp"
#include "coupling/core/law/rheology_file.hpp"
#include "tests/files/folder.hpp"

namespace drumlin::robust_law {
using namespace coupling;
namespace {

const FrictionForm log_linear{.formula = LogLinearLaw{}};
const FrictionForm logarithm{.formula = LogLaw{}};
const Coefficients truth{0.33, 0.011, 0.6};
const FrictionForm jop{.formula = JopLaw{}};
const Coefficients glass{0.383, 0.26, 0.279};  // mu_s, mu_2 - mu_s, I_0

/// Layers of I from 1e-4 to 0.1 with normal noise.
std::vector<FrictionPoint> layers(const Coefficients& law, double noise, int count, unsigned seed,
                                  bool errors_known = true) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<FrictionPoint> points;
  for (int i = 0; i < count; ++i) {
    const double I = 1e-4 * std::pow(1e3, (i + 0.5) / count);
    points.push_back(
        {I, friction(log_linear, law, I) + noise * normal(random), 0, errors_known ? noise : NAN});
  }
  return points;
}

TEST(RobustLaw, IsExactForPointsOnIt) {
  for (const bool known : {true, false}) {
    const RobustFriction fit = fit_friction(layers(truth, 0, 30, 1, known), log_linear);
    EXPECT_NEAR(fit.law[0], truth[0], 1e-9);
    EXPECT_NEAR(fit.law[1], truth[1], 1e-9);
    EXPECT_NEAR(fit.law[2], truth[2], 1e-8);
    EXPECT_EQ(fit.intrinsic_scatter, 0);
  }
}

TEST(RobustLaw, IsHardlyMovedByLayersThatAreFarOff) {
  auto points = layers(truth, 0.003, 60, 2);
  const Coefficients before = fit_friction(points, log_linear).law;
  for (const std::size_t bad : {3, 20, 41, 57}) points[bad].mu += 0.3;
  const Coefficients after = fit_friction(points, log_linear).law;
  for (const double I : {1e-3, 1e-2, 0.08})
    EXPECT_NEAR(friction(log_linear, after, I), friction(log_linear, before, I), 0.003) << I;
}

TEST(RobustLaw, FindsTheScatterThatErrorsDoNotExplain) {
  auto points = layers(truth, 0.01, 400, 3);
  for (FrictionPoint& point : points) point.mu_error = 0.006;
  EXPECT_NEAR(fit_friction(points, log_linear).intrinsic_scatter, 0.008, 0.001);
}

TEST(RobustLaw, HoldsASlopeThatWouldBeNegativeAtNought) {
  const Coefficients falling{0.3, 0.02, -0.5};
  const RobustFriction fit = fit_friction(layers(falling, 0, 40, 4), log_linear);
  EXPECT_EQ(fit.law[2], 0);
  EXPECT_GT(fit.law[1], 0);
}

TEST(RobustLaw, BandOfItsDrawsHoldsTheTruthAsOftenAsItSays) {
  int inside = 0, compared = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const auto points = layers(truth, 0.01, 60, 100 + seed);
    const BandOfDraws draws(log_linear, bootstrapped({points}, log_linear, 100));
    for (const double I : {1e-3, 1e-2, 0.05}) {
      const FrictionBand band = draws.at(I, 0.9);
      inside += band.low <= friction(log_linear, truth, I) && friction(log_linear, truth, I) <= band.high;
      ++compared;
    }
  }
  EXPECT_NEAR(static_cast<double>(inside) / compared, 0.9, 0.1);
}

/// Inclines: at each slope a few layers, whose mu is one and whose I all are off by the same share.
std::vector<std::vector<FrictionPoint>> inclines(double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<std::vector<FrictionPoint>> runs;
  for (const double I : {0.04, 0.07, 0.11, 0.16, 0.22, 0.3, 0.4}) {
    const double mu = friction(jop, glass, I), off = 1 + noise * normal(random);
    runs.push_back({});
    for (int layer = 0; layer < 4; ++layer) runs.back().push_back({I * off, mu, noise * I, 1e-4});
  }
  return runs;
}

TEST(RobustLaw, OfJopIsExactForPointsOnIt) {
  const RobustFriction fit = fit_friction(all_of(inclines(0, 1)), jop);
  for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(fit.law[j], glass[j], 1e-8) << j;
}

TEST(RobustLaw, BandOfShortRunsHoldsTheTruthAsOftenAsItSays) {
  int inside = 0, compared = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const BandOfDraws draws(jop, bootstrapped(inclines(0.05, 200 + seed), jop, 100));
    for (const double I : {0.06, 0.13, 0.3}) {
      const FrictionBand band = draws.at(I, 0.9);
      inside += band.low <= friction(jop, glass, I) && friction(jop, glass, I) <= band.high;
      ++compared;
    }
  }
  EXPECT_NEAR(static_cast<double>(inside) / compared, 0.9, 0.1);
}

TEST(RobustLaw, OfJopCrossesToTheFlowWithItsRangeAndDraws) {
  std::vector<RunEvidence> runs;
  for (const auto& layers : inclines(0.02, 7))
    runs.push_back({.name = "incline", .nu = {"nu_bulk", 0.56, {}}, .layers = layers});
  const CalibrationOptions options{.source = EvidenceSource::profiles, .form = "jop", .draws = 30};
  const RheologyFit fit =
      parse_rheology(rheology_text(calibration_of(runs, {}, options).rheology), "law.toml");
  const JopLaw law = std::get<JopLaw>(fit.mu);
  EXPECT_NEAR(law.mu_s, glass[0], 0.02);
  EXPECT_NEAR(*law.I_max, 0.4, 0.03);
  EXPECT_GT(fit.draws.size(), 10u);
  // Points that bend upwards have no I_0.
  for (RunEvidence& run : runs)
    for (FrictionPoint& point : run.layers) point.mu = 0.3 + 10 * point.I * point.I;
  expect_has(message_of<InputError>([&] { (void)calibration_of(runs, {}, options); }),
             "do not determine a law \"jop\"");
}

TEST(RobustLaw, DrawsAreTheSameEachTime) {
  const auto points = layers(truth, 0.01, 30, 5);
  const auto once = bootstrapped({points, points}, logarithm, 5),
             again = bootstrapped({points, points}, logarithm, 5);
  for (std::size_t k = 0; k < once.size(); ++k) EXPECT_EQ(once[k], again[k]);
}

TEST(RobustLaw, ATableFollowsWhatNoFormulaDoes) {
  // The limiter of the flow's cubic acts at both inner knots.
  const FrictionTable truth_table{{1e-4, 1e-3, 1e-2, 1e-1}, {0.15, 0.23, 0.24, 0.34}};
  const FrictionLaw bent = truth_table;
  std::vector<FrictionPoint> points;
  for (int i = 0; i < 120; ++i) {
    const double I = 1e-4 * std::pow(1e3, (i + 0.5) / 120);
    points.push_back({I, friction_at(bent, I).mu, 0, 0.005});
  }
  const FrictionForm table{.kind = FormKind::table, .knots = truth_table.I};
  const RobustFriction fit = fit_friction(points, table);
  // What keeps neighbouring intervals equally steep has the weight of a hundredth of a point.
  for (const double I : {2e-4, 1e-3, 1e-2, 0.08})
    EXPECT_NEAR(friction(table, fit.law, I), friction_at(bent, I).mu, 2e-4) << I;
  EXPECT_NEAR(friction_slope(table, fit.law, 3e-4), friction_at(bent, 3e-4).slope, 1e-3);
}

TEST(RobustLaw, ATableOfFlatPointsIsKeptWellPosedWhereverItHasPoints) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 0.01);
  std::vector<FrictionPoint> points;
  for (int i = 0; i < 200; ++i) {
    const double I = 1e-4 * std::pow(1e3, (i + 0.5) / 200);
    points.push_back({I,
                      (I < 1e-3   ? 0.2
                       : I < 2e-2 ? 0.27 - 0.01 * std::log(I / 1e-3)
                                  : 0.33) +
                          normal(random),
                      0, 0.01});
  }
  const FrictionForm table{.kind = FormKind::table, .knots = {1e-4, 1e-3, 3e-3, 8e-3, 2e-2, 1e-1}};
  const CalibratedLaw law = calibrated({points}, table, 5);
  EXPECT_GT(held_intervals(law.form, law.fit.law), 0u);
  const FrictionLaw mu = measured_friction(law.form, law.fit.law, {}, 1e-4, 1e-1);
  EXPECT_TRUE(ill_posed_intervals(mu, nullptr, 1e-4, 1e-1).empty());
}

TEST(RobustLaw, ATableNeverFalls) {
  std::vector<FrictionPoint> points;
  for (int i = 0; i < 60; ++i) {
    const double I = 1e-4 * std::pow(1e3, (i + 0.5) / 60);
    points.push_back({I, I < 3e-3 ? 0.3 : 0.2 + 0.1 * I, 0, 0.01});
  }
  const FrictionForm table{.kind = FormKind::table, .knots = {1e-4, 1e-3, 1e-2, 1e-1}};
  const RobustFriction fit = fit_friction(points, table);
  for (std::size_t j = 1; j < fit.law.size(); ++j) EXPECT_GT(fit.law[j], 0) << j;
}

TEST(RobustLaw, KnotsHoldPointsBetweenThem) {
  std::vector<double> I;
  for (int i = 0; i < 50; ++i) I.push_back(std::pow(10, -4 + 3 * std::pow(i / 49.0, 3)));
  const std::vector<double> knots = table_knots(I);
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const auto between =
        std::count_if(I.begin(), I.end(), [&](double v) { return knots[k] <= v && v <= knots[k + 1]; });
    EXPECT_GE(between, 6) << k;
  }
  EXPECT_EQ(knots.front(), I.front());
  EXPECT_EQ(knots.back(), I.back());
}

TEST(RobustLaw, NeedsMorePointsThanCoefficients) {
  EXPECT_THROW(fit_friction(layers(truth, 0, 3, 1), log_linear), InputError);
  EXPECT_THROW(fit_friction({{0.1, 0.3, 0, 0}, {0.1, 0.31, 0, 0}, {0.1, 0.32, 0, 0}}, logarithm), InputError);
}

}  // namespace
}  // namespace drumlin::robust_law
