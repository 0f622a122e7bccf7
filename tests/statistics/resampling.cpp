#include "coupling/core/statistics/resampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "coupling/core/statistics/samples.hpp"

namespace drumlin::statistics {
namespace {

std::vector<double> means_without_one(const std::vector<double>& values) {
  std::vector<double> means;
  for (std::size_t left_out = 0; left_out < values.size(); ++left_out) {
    std::vector<double> rest = values;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
    means.push_back(mean(rest));
  }
  return means;
}

TEST(Jackknife, OfTheMeanIsItsStandardError) {
  // Neighbours that part count as independent.
  for (const auto& values : {std::vector<double>{2, 7, 1, 8, 2, 8}, {-1, 1, -1, 1}})
    EXPECT_NEAR(jackknife_variance(means_without_one(values)),
                variance(values) / static_cast<double>(values.size()), 1e-14);
}

TEST(Jackknife, AddsNeighboursThatGoTogether) {
  // Means without one of -3, -1, 1, 3 are 1, 1/3, -1/3, -1: squares 20/9, neighbours 5/9.
  EXPECT_NEAR(jackknife_variance(means_without_one({-3, -1, 1, 3})), 3.0 / 4 * (20 + 2 * 5) / 9, 1e-14);
}

TEST(Jackknife, NeedsTwoNumbers) {
  EXPECT_TRUE(std::isnan(jackknife_variance(std::vector<double>{1.0})));
  EXPECT_TRUE(
      std::isnan(jackknife_variance(std::vector<double>{1.0, std::numeric_limits<double>::quiet_NaN()})));
}

TEST(Bootstrap, TheSameSeedDrawsTheSame) {
  std::mt19937_64 one(7), same(7), other(8);
  const auto draw = block_draw(101, 4, one);
  EXPECT_EQ(draw, block_draw(101, 4, same));
  EXPECT_NE(draw, block_draw(101, 4, other));
  EXPECT_NE(draw, block_draw(101, 4, one)) << "the generator goes on";
}

TEST(Bootstrap, DrawsWholeBlocksThatGoRound) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const auto draw = block_draw(10, 4, random);
    ASSERT_EQ(draw.size(), 10u);
    for (std::size_t i = 0; i < draw.size(); ++i)
      if (i % 4 != 0) {
        EXPECT_EQ(draw[i], (draw[i - 1] + 1) % 10);
      }
  }
}

TEST(Bootstrap, SpreadOfTheMeanIsItsStandardError) {
  std::vector<double> values, means;
  std::mt19937_64 random(5);
  for (int i = 0; i < 200; ++i) values.push_back(static_cast<double>(random() % 1000));
  for (int b = 0; b < 4000; ++b) {
    std::vector<double> drawn;
    for (const std::size_t i : block_draw(values.size(), 1, random)) drawn.push_back(values[i]);
    means.push_back(mean(drawn));
  }
  // 4000 draws know a variance to 2 % (one standard error).
  EXPECT_NEAR(variance(means) / (variance(values) / 200), 1, 0.08);
}

}  // namespace
}  // namespace drumlin::statistics
