#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/straight_line.hpp"

namespace drumlin::statistics {
namespace {

using Values = std::vector<double>;

const Values some_x{-1, 0.5, 2, 3, 7}, some_y{2, 1, 4, 3.5, 9}, some_variance{0.1, 0.4, 0.2, 1, 0.3};

void expect_near(const StraightLine& a, const StraightLine& b) {
  EXPECT_NEAR(a.slope, b.slope, 1e-12 * std::abs(b.slope));
  EXPECT_NEAR(a.intercept, b.intercept, 1e-12 * (std::abs(b.intercept) + std::abs(b.slope)));
  EXPECT_NEAR(a.var_slope, b.var_slope, 1e-12 * b.var_slope);
  EXPECT_NEAR(a.var_intercept, b.var_intercept, 1e-12 * b.var_intercept);
  EXPECT_NEAR(a.covariance, b.covariance, 1e-12 * std::sqrt(b.var_slope * b.var_intercept));
}

TEST(StraightLine, ByHand) {
  // Means 1 and 2: sxx = 2, sxy = 2; residuals 1/3 (1, -2, 1) about y = 1 + x.
  const StraightLine line = *fit_line(Values{0, 1, 2}, Values{4.0 / 3, 4.0 / 3, 10.0 / 3});
  EXPECT_NEAR(line.slope, 1, 1e-15);
  EXPECT_NEAR(line.intercept, 1, 1e-15);
  EXPECT_NEAR(line.var_slope, 1.0 / 2, 1e-15);
  EXPECT_NEAR(line.var_intercept, 1.0 / 3 + 1.0 / 2, 1e-15);
  EXPECT_NEAR(line.covariance, -1.0 / 2, 1e-15);
  EXPECT_NEAR(line.chi_squared, 6.0 / 9, 1e-15);
  EXPECT_EQ(line.degrees_of_freedom, 1);
  EXPECT_NEAR(line.reduced_chi_squared(), 2.0 / 3, 1e-15);
}

TEST(StraightLine, PointsOnALineComeBack) {
  Values y;
  for (const double x : some_x) y.push_back(3 - 0.5 * x);
  const StraightLine line = *fit_line(some_x, y, some_variance);
  EXPECT_NEAR(line.slope, -0.5, 1e-14);
  EXPECT_NEAR(line.intercept, 3, 1e-14);
  EXPECT_NEAR(line.chi_squared, 0, 1e-25);
}

TEST(StraightLine, VariancesOfOneAreNoVariances) {
  const Values ones(some_x.size(), 1.0);
  expect_near(*fit_line(some_x, some_y), *fit_line(some_x, some_y, ones));
}

// x' = 5 x + 1000, y' = 2 y - 3 x + 7: slope, intercept and their covariance follow.
TEST(StraightLine, IsAffinelyInvariant) {
  Values x, y, variance;
  for (std::size_t i = 0; i < some_x.size(); ++i) {
    x.push_back(5 * some_x[i] + 1000);
    y.push_back(2 * some_y[i] - 3 * some_x[i] + 7);
    variance.push_back(4 * some_variance[i]);
  }
  const StraightLine line = *fit_line(some_x, some_y, some_variance), moved = *fit_line(x, y, variance);
  const double slope = (2 * line.slope - 3) / 5;
  EXPECT_NEAR(moved.slope, slope, 1e-13);
  EXPECT_NEAR(moved.intercept, 2 * line.intercept + 7 - 1000 * slope, 1e-10);
  EXPECT_NEAR(moved.chi_squared, line.chi_squared, 1e-9);
  EXPECT_NEAR(moved.var_slope, 4 * line.var_slope / 25, 1e-14);
  EXPECT_NEAR(moved.covariance, 4 * (line.covariance - 200 * line.var_slope) / 5, 1e-9);
  EXPECT_NEAR(moved.var_intercept, 4 * (line.var_intercept - 400 * line.covariance + 4e4 * line.var_slope),
              1e-6);
}

TEST(StraightLine, AWeightIsAsManyRepetitions) {
  const Values x{0, 1, 3, 4}, y{1, 3, 4, 8};
  const StraightLine weighted = *fit_line(x, y, Values{1, 0.5, 1, 1.0 / 3});
  const StraightLine repeated = *fit_line(Values{0, 1, 1, 3, 4, 4, 4}, Values{1, 3, 3, 4, 8, 8, 8});
  expect_near(weighted, repeated);
  EXPECT_NEAR(weighted.chi_squared, repeated.chi_squared, 1e-13);
  EXPECT_EQ(weighted.degrees_of_freedom, 2);  // repeated values are no new measurements
}

TEST(StraightLine, NeedsTwoPlaces) {
  EXPECT_FALSE(fit_line(Values{1}, Values{2}));
  EXPECT_FALSE(fit_line(Values{}, Values{}));
  EXPECT_FALSE(fit_line(Values{2, 2, 2}, Values{1, 2, 3}));
  EXPECT_FALSE(fit_line(Values{1, std::numeric_limits<double>::quiet_NaN()}, Values{1, 2}));
}

TEST(StraightLine, RelativeVariancesDoNotKnowTheirUnit) {
  Values scaled;
  for (const double variance : some_variance) scaled.push_back(100 * variance);
  const auto half_width = [](const StraightLine& line, Variances variances) {
    return interval_factor_99(line, variances) * std::sqrt(line.var_slope);
  };
  const StraightLine line = *fit_line(some_x, some_y, some_variance),
                     other = *fit_line(some_x, some_y, scaled);
  EXPECT_NEAR(half_width(other, Variances::relative), half_width(line, Variances::relative), 1e-12);
  EXPECT_NEAR(half_width(other, Variances::known), 10 * half_width(line, Variances::known), 1e-12);
  EXPECT_GE(half_width(other, Variances::stated), half_width(other, Variances::known));
  EXPECT_GE(half_width(line, Variances::stated), half_width(line, Variances::relative));
}

TEST(StraightLine, TwoPointsSayNothingOfTheirScatter) {
  const StraightLine line = *fit_line(Values{0, 1}, Values{1, 3});
  EXPECT_EQ(line.degrees_of_freedom, 0);
  EXPECT_TRUE(std::isnan(interval_factor_99(line, Variances::relative)));
  EXPECT_EQ(interval_factor_99(line, Variances::stated), normal_quantile_99);
}

}  // namespace
}  // namespace drumlin::statistics
