#include "coupling/core/statistics/quantiles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace drumlin::statistics {
namespace {

TEST(Quantiles, OfStudentsTAreThoseOfTheTables) {
  // Abramowitz & Stegun, Handbook of Mathematical Functions (1964), table 26.10: three decimals.
  for (const auto& [freedom, value] : {std::pair(1, 63.657),
                                       {2, 9.925},
                                       {3, 5.841},
                                       {4, 4.604},
                                       {5, 4.032},
                                       {9, 3.250},
                                       {10, 3.169},
                                       {19, 2.861},
                                       {30, 2.750},
                                       {120, 2.617}})
    EXPECT_NEAR(student_quantile_99(freedom), value, 5.1e-4) << freedom;
}

TEST(Quantiles, OfStudentsTHaveClosedFormsForOneAndTwoDegreesOfFreedom) {
  EXPECT_NEAR(student_quantile_99(1), std::tan(0.495 * std::numbers::pi), 1e-11);
  EXPECT_NEAR(student_quantile_99(2), 0.99 * std::sqrt(2 / (1 - 0.99 * 0.99)), 1e-12);
}

TEST(Quantiles, OfStudentsTFallToThatOfTheNormalDistribution) {
  for (int freedom = 1; freedom < 200; ++freedom)
    EXPECT_GT(student_quantile_99(freedom), student_quantile_99(freedom + 1));
  EXPECT_NEAR(student_quantile_99(100000000), normal_quantile_99, 1e-6);
  // P(|x| <= value) = erf(value/sqrt(2)).
  EXPECT_NEAR(std::erf(normal_quantile_99 / std::numbers::sqrt2), 0.99, 1e-14);
}

TEST(Quantiles, OfToldErrorsAreTheLargerOfBoth) {
  EXPECT_EQ(quantile_99_of_stated_errors(std::numeric_limits<double>::quiet_NaN(), 0), normal_quantile_99);
  EXPECT_EQ(quantile_99_of_stated_errors(0, 4), normal_quantile_99);
  EXPECT_DOUBLE_EQ(quantile_99_of_stated_errors(4, 1), 2 * student_quantile_99(1));
}

}  // namespace
}  // namespace drumlin::statistics
