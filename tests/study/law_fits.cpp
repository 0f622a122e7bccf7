#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coupling/statistics/quantiles.hpp"
#include "coupling/study/law_fit.hpp"

namespace drumlin {
using namespace coupling;
namespace {

constexpr double some_Q[] = {7.3, 14.5, 18.2, 21.8, 36.0, 53.9};

TEST(LawFit, PointsOnALineGiveTheLine) {
  std::vector<LawPoint> points;
  for (const double Q : some_Q) points.push_back({Q, 0.31 + 1.9e-3 * Q, 0.1, 0.01});
  const LawFit fit = fit_line(points);
  EXPECT_NEAR(fit.coefficients[0].value, 0.31, 1e-12);
  EXPECT_NEAR(fit.coefficients[1].value, 1.9e-3, 1e-14);
  EXPECT_NEAR(fit.reduced_chi2, 0, 1e-18);
  EXPECT_GT(fit.coefficients[1].ci99, 0) << "the points' own errors remain";
}

TEST(LawFit, PowerAndProportion) {
  std::vector<LawPoint> power, proportion;
  for (const double Q : some_Q) {
    power.push_back({Q, 3 * std::sqrt(Q), 0.1, 0.2});
    proportion.push_back({std::sqrt(Q), 3 * std::sqrt(Q)});
  }
  EXPECT_NEAR(fit_power(power).coefficients[0].value, 3, 1e-9);
  EXPECT_NEAR(fit_power(power).coefficients[1].value, 0.5, 1e-9);
  EXPECT_NEAR(fit_proportional(proportion).coefficients[0].value, 3, 1e-12);
}

TEST(LawFit, MeanOfEqualErrorsHasTheirErrorOverTheRootOfTheirNumber) {
  // Without scatter: c of y = c 1.
  const LawFit fit =
      fit_proportional({{1, 5, NAN, 0.4}, {1, 5, NAN, 0.4}, {1, 5, NAN, 0.4}, {1, 5, NAN, 0.4}});
  EXPECT_NEAR(fit.coefficients[0].ci99, 0.2, 1e-12);
}

TEST(LawFit, PointsWithoutIntervalsStandAsideOnlyWhereOthersHaveThem) {
  EXPECT_EQ(fit_line({{1, 1}, {2, 2}, {3, 3}}).points, 3u);
  EXPECT_EQ(fit_line({{1, 1, 0, 0.1}, {2, 2, 0, 0.1}, {3, 9}}).points, 2u);
  EXPECT_EQ(fit_line({{1, 1, 0, 0.1}, {NAN, 2, 0, 0.1}, {3, NAN, 0, 0.1}}).points, 1u);
}

TEST(LawFit, TooFewPointsGiveNothing) {
  const LawFit fit = fit_line({{1, 1, 0, 0.1}});
  EXPECT_TRUE(std::isnan(fit.coefficients[0].value));
  EXPECT_TRUE(std::isnan(fit_line({}).coefficients[1].ci99));
}

/// Share of 4000 noisy data sets whose interval of c1 holds the true one. `noise` is what the points really
/// scatter by, `told` what their intervals say.
double coverage(double noise, double told) {
  std::mt19937_64 engine(7);
  std::normal_distribution<double> normal(0, 1);
  int inside = 0;
  constexpr int trials = 4000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<LawPoint> points;
    for (const double Q : some_Q)
      points.push_back(
          {Q, 10 + 0.2 * Q + noise * normal(engine), NAN, statistics::normal_quantile_99 * told});
    const auto slope = fit_line(points).coefficients[1];
    inside += std::abs(slope.value - 0.2) <= slope.ci99;
  }
  return inside / double(trials);
}

TEST(LawFit, IntervalsHoldTheTrueCoefficient) {
  // Right errors: at least 99 % (the larger of two intervals is taken); binomial error of 4000 trials 0.16 %.
  EXPECT_GT(coverage(0.5, 0.5), 0.985);
  // Errors told four times too small: the scatter takes over, Student's t with 4 degrees of freedom.
  EXPECT_GT(coverage(0.5, 0.125), 0.98);
}

TEST(LawFit, ErrorsOfXWidenTheIntervals) {
  std::vector<LawPoint> exact, uncertain;
  for (const double Q : some_Q) {
    exact.push_back({Q, 2 * Q, 0, 0.5});
    uncertain.push_back({Q, 2 * Q, 0.5, 0.5});
  }
  EXPECT_NEAR(fit_line(uncertain).coefficients[1].ci99 / fit_line(exact).coefficients[1].ci99, std::sqrt(5),
              1e-9);
}

}  // namespace
}  // namespace drumlin
