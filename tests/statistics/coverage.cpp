// 99 % intervals from few samples: how often they hold the truth. 40000 trials know a share of 0.99 to 0.05 %
// (one standard error), so that 0.5 % are ten of them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/samples.hpp"
#include "coupling/core/statistics/straight_line.hpp"

namespace drumlin::statistics {
namespace {

constexpr int trials = 40000;

double share_inside(const std::function<bool(const std::vector<double>&)>& holds_zero, std::size_t samples) {
  std::mt19937_64 engine(11);
  std::normal_distribution<double> normal;
  int inside = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> values;
    for (std::size_t i = 0; i < samples; ++i) values.push_back(normal(engine));
    inside += holds_zero(values);
  }
  return inside / double(trials);
}

std::vector<double> places(std::size_t count) {
  std::vector<double> x;
  for (std::size_t i = 0; i < count; ++i) x.push_back(std::pow(2.0, static_cast<double>(i)));
  return x;
}

class FewSamples : public ::testing::TestWithParam<std::size_t> {};

TEST_P(FewSamples, HoldTheirMean) {
  const std::size_t n = GetParam();
  const auto holds = [n](double quantile) {
    return [n, quantile](const std::vector<double>& values) {
      return std::abs(mean(values)) <= quantile * std::sqrt(variance(values) / static_cast<double>(n));
    };
  };
  EXPECT_NEAR(share_inside(holds(student_quantile_99(static_cast<int>(n) - 1)), n), 0.99, 0.005);
  // The quantile of the normal distribution holds it in 76, 88, 92, 94 % only.
  EXPECT_LT(share_inside(holds(normal_quantile_99), n), 0.95);
}

TEST_P(FewSamples, OfALineHoldTheSlope) {
  const auto x = places(GetParam() + 1);  // 1 to 4 degrees of freedom
  const auto holds = [&](const std::vector<double>& y) {
    const StraightLine line = *fit_line(x, y);
    return std::abs(line.slope) <= interval_factor_99(line, Variances::relative) * std::sqrt(line.var_slope);
  };
  EXPECT_NEAR(share_inside(holds, x.size()), 0.99, 0.005);
}

// Errors told right, three times too small, three times too large: 99 % or more.
TEST_P(FewSamples, WithToldErrorsHoldTheSlopeWhateverTheyTell) {
  const auto x = places(GetParam() + 1);
  for (const double stated : {1.0, 1.0 / 3, 3.0}) {
    const std::vector<double> variance(x.size(), stated * stated);
    const auto holds = [&](const std::vector<double>& y) {
      const StraightLine line = *fit_line(x, y, variance);
      return std::abs(line.slope) <= interval_factor_99(line, Variances::stated) * std::sqrt(line.var_slope);
    };
    EXPECT_GT(share_inside(holds, x.size()), 0.985) << stated;
  }
}

INSTANTIATE_TEST_SUITE_P(Coverage, FewSamples, ::testing::Values(2, 3, 4, 5));

}  // namespace
}  // namespace drumlin::statistics
