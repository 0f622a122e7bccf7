#include "particles/distributed/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "particles/distributed/ranks.hpp"

namespace drumlin::particles {
namespace {

std::vector<double> terms_of_all_sizes() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> digits(-1, 1);
  std::uniform_int_distribution<int> exponent(-90, 60);
  std::vector<double> terms;
  for (int k = 0; k < 5000; ++k) terms.push_back(std::ldexp(digits(random), exponent(random)));
  return terms;
}

double sum_of(const std::vector<double>& terms) {
  ExactSum sum;
  for (const double term : terms) sum.add(term);
  return sum.value();
}

TEST(ExactSum, IsTheSameInAnyOrder) {
  std::vector<double> terms = terms_of_all_sizes();
  const double sum = sum_of(terms);
  std::mt19937_64 random(2);
  for (int k = 0; k < 5; ++k) {
    std::shuffle(terms.begin(), terms.end(), random);
    EXPECT_EQ(sum_of(terms), sum);
  }
}

TEST(ExactSum, KeepsWhatLargeTermsWouldSwallow) {
  EXPECT_EQ(sum_of({1e30, 1e-30, -1e30}), 1e-30);
  EXPECT_EQ(sum_of({-1e-30}), -1e-30);
  EXPECT_EQ(sum_of({0x1p100, -0x1p100, -3}), -3);
  EXPECT_EQ(sum_of({}), 0);
  EXPECT_EQ(sum_of({1.5, 2.25, -0.75}), 3);
}

double sum_of_many(const std::vector<double>& terms) {
  ExactSum sum;
  sum.add_terms(terms.size(), [&](std::size_t k) { return terms[k]; });
  return sum.value();
}

TEST(ExactSum, OfManyTermsIsThatOfEach) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> terms = terms_of_all_sizes();
  for (double& term : terms) term = std::abs(term);
  std::mt19937_64 random(3);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(sum_of_many(terms), sum_of(terms));
    for (const double more : {0.0, 0x1p127, 0x1.fffffffffffffp127, 0x1p-287, 0x1p-300, 0x1p-1070})
      terms.insert(terms.end(), 2, more);
    std::shuffle(terms.begin(), terms.end(), random);
  }
  // The largest digits at each place, more of them than one sum of integers takes.
  for (int place = -60; place < 10; ++place) {
    const std::vector<double> alike(5000, std::ldexp(0x1.fffffffffffffp0, place));
    EXPECT_EQ(sum_of_many(alike), std::ldexp(0x1.fffffffffffffp0 * 5000, place)) << place;
    EXPECT_EQ(sum_of_many(alike), sum_of(alike)) << place;
  }
  EXPECT_EQ(sum_of_many({}), 0);
  EXPECT_EQ(sum_of_many({-0.0, 3, -0.0}), 3);
  EXPECT_TRUE(std::isnan(sum_of_many({3, -1})));
  EXPECT_TRUE(std::isnan(sum_of_many({1, infinity, 2})));
  EXPECT_TRUE(std::isnan(sum_of_many({0x1p128})));
}

// One part in 2^52 of what is added: the sum itself is exact, only its value is rounded.
TEST(ExactSum, IsTheSumOfLongDoubles) {
  const std::vector<double> terms = terms_of_all_sizes();
  long double sum = 0, size = 0;
  for (const double term : terms) sum += term, size += std::abs(term);
  EXPECT_NEAR(sum_of(terms), static_cast<double>(sum), static_cast<double>(size) * 0x1p-52);
}

TEST(ExactSum, OfWhatIsNoNumberIsNone) {
  EXPECT_TRUE(std::isnan(sum_of({1, std::numeric_limits<double>::infinity()})));
  EXPECT_TRUE(std::isnan(sum_of({std::numeric_limits<double>::quiet_NaN(), 1})));
  EXPECT_TRUE(std::isnan(sum_of({0x1p200})));
}

TEST(ExactSum, DoesNotKnowWhichRankAdded) {
  const Ranks ranks;
  const std::vector<double> terms = terms_of_all_sizes();
  ExactSum own;
  for (std::size_t k = ranks.rank(); k < terms.size(); k += ranks.count()) own.add(terms[k]);
  ranks.add(own.numbers());
  EXPECT_EQ(own.value(), sum_of(terms));
}

}  // namespace
}  // namespace drumlin::particles
