#include "coupling/calibration/law_points.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "coupling/calibration/fabric_relaxation.hpp"
#include "coupling/calibration/judgement.hpp"
#include "coupling/exchange/errors.hpp"

namespace drumlin {
namespace {

const FrictionForm logarithm{FormKind::log, {}};
const Coefficients truth{0.36, 0.014};
constexpr double turn = 0.05;  // of the stress, at every I

/// A layer under its own weight that shears ever more slowly downwards, turned by `angle` against the axes of
/// the map; noise of the stresses and of the gradient as shares of p and |D|, two neighbouring nodes alike.
FieldMap layer(double angle, double of_stress, double of_gradient, unsigned seed = 1) {
  FieldMap map;
  map.grid = {-30, -40, 1, 1, 61, 40};
  map.header = {{"drum_radius", "0"}, {"axis_depth", "0"}, {"rotation", "0"}};
  const std::vector<std::string> names{"nu",       "v_x",      "v_z",      "sigma_xx", "sigma_zz", "sigma_xz",
                                       "sigma_zx", "d_v_x_dx", "d_v_x_dz", "d_v_z_dx", "d_v_z_dz"};
  for (const std::string& name : names) map.fields.push_back({name, {}, {}});
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  const double c = std::cos(2 * angle), s = std::sin(2 * angle);
  std::array<double, 8> shaken_by{};
  for (std::size_t row = 0; row < map.grid.rows; ++row)
    for (std::size_t column = 0; column < map.grid.columns; ++column) {
      const double p = 0.8 * (1 - map.grid.z_of(row));
      const double I = 0.1 * std::exp(map.grid.z_of(row) / 7), D = 0.5 * I * std::sqrt(p);
      const double M = friction(logarithm, truth, I);
      // Traceless tensors ((a, b), (b, -a)) turn by twice the angle.
      const double D_a = D * s, D_b = D * c;
      const double tau_a = p * (M * s - turn * c), tau_b = p * (M * c + turn * s);
      if (column % 2 == 0)
        for (double& z : shaken_by) z = normal(random);
      std::size_t next = 0;
      const auto shaken = [&](double value, double size) { return value + size * shaken_by[next++]; };
      const double e = of_gradient * D, f = of_stress * p;
      const double values[] = {0.8,
                               0,
                               0,
                               shaken(p - tau_a, f),
                               shaken(p + tau_a, f),
                               shaken(tau_b, f),
                               shaken(tau_b, f),
                               shaken(D_a, e),
                               shaken(D_b + 0.3 * D, e),
                               shaken(D_b - 0.3 * D, e),
                               shaken(-D_a, e)};
      for (std::size_t i = 0; i < names.size(); ++i) {
        map.fields[i].value.push_back(values[i]);
        if (i >= 3) map.fields[i].ci99.push_back(2.576 * (i < 7 ? f : e));
      }
    }
  return map;
}

const BlockSelection anywhere{.I_min = 1e-5, .I_max = 1, .wall_margin = 0};

TEST(LawPoints, ReadTheLawInAnyAxes) {
  for (const double angle : {0.0, 0.3, -0.7}) {
    const auto points = law_points(layer(angle, 0, 0), anywhere);
    ASSERT_GT(points.size(), 100u);
    for (const LawBlock& point : points) {
      EXPECT_NEAR(point.friction.mu, friction(logarithm, truth, point.friction.I), 1e-12);
      EXPECT_NEAR(point.turn, turn, 1e-12);
    }
  }
}

TEST(LawPoints, NoiseOfTheGradientIsTakenOffItsLength) {
  // Without it |D| is 4 % too long in a block of ten nodes, and mu as much too small.
  double mu = 0, I = 0, count = 0;
  for (const LawBlock& point : law_points(layer(0, 0, 0.6), anywhere)) {
    const double clean = 0.1 * std::exp(point.z / 7);
    mu += point.friction.mu / friction(logarithm, truth, clean);
    I += point.friction.I / clean;
    ++count;
  }
  EXPECT_NEAR(mu / count, 1, 0.03);  // dividing by a noisy length leaves its square
  EXPECT_NEAR(I / count, 1, 0.02);
}

TEST(LawPoints, ALawWithKIsThatOfSimpleShear) {
  const auto points = law_points(layer(0, 0, 0), anywhere);
  const double k = (1 + turn) / (1 - turn);
  const FrictionForm table{FormKind::table, {1e-4, 1e-1}, false};
  const auto with_k = frictions_with_k(points, table, {turn, 0.0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    // sigma_zz = 2p/(1 + k), sigma_xz = M p, I = 2|D|/sqrt(sigma_zz).
    EXPECT_NEAR(with_k[i].mu, points[i].friction.mu * (1 + k) / 2, 1e-12);
    EXPECT_NEAR(with_k[i].I, points[i].friction.I * std::sqrt((1 + k) / 2), 1e-12);
  }
  for (const double ratio : stress_ratio(table, {turn, 0.0}).k) EXPECT_NEAR(ratio, k, 1e-12);
}

TEST(LawPoints, AKnownLawComesBackWithinItsBand) {
  int inside = 0, asked = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    const CalibratedLaw law =
        calibrated({frictions(law_points(layer(0.2, 0.1, 0.1, seed), anywhere))}, logarithm, 100);
    for (const double I : {5e-4, 5e-3, 5e-2}) {
      const FrictionBand band = band_at(law.form, law.draws, I);
      inside += band.low <= friction(logarithm, truth, I) && friction(logarithm, truth, I) <= band.high;
      ++asked;
    }
  }
  EXPECT_GE(inside, asked - 3) << asked;
}

TEST(LawPoints, AMapWithoutWhatTheLawNeedsIsRefused) {
  FieldMap map = layer(0, 0, 0);
  map.fields.erase(map.fields.begin() + 3);
  EXPECT_THROW(law_points(map, anywhere), InputError);
  map = layer(0, 0, 0);
  map.header.erase("axis_depth");
  EXPECT_THROW(law_points(map, anywhere), InputError);
}

TEST(OneLaw, HoldsForSpeedsOfOneLawAndNotForTwo) {
  const auto with = [](double a, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 0.004);
    std::vector<FrictionPoint> points;
    for (int i = 0; i < 80; ++i) {
      const double I = 1e-4 * std::pow(1e3, (i + 0.5) / 80);
      points.push_back({I, a + 0.014 * std::log(I) + normal(random), 0, 0.004});
    }
    return std::vector<std::vector<FrictionPoint>>{points};
  };
  const auto verdict = [&](double a) {
    const auto slow = with(0.36, 1), fast = with(a, 2);
    const CalibratedLaw common = calibrated({slow[0], fast[0]}, logarithm, 100);
    return one_law_of({{"slow", slow}, {"fast", fast}}, common, 100);
  };
  EXPECT_TRUE(verdict(0.36).holds);
  const OneLaw two = verdict(0.40);
  EXPECT_FALSE(two.holds);
  EXPECT_GT(two.rms_common, 2 * two.rms_own);
}

TEST(LawScore, SaysHowFarAHeldOutRunLies) {
  std::vector<FrictionPoint> points;
  for (int i = 0; i < 40; ++i) {
    const double I = 1e-4 * std::pow(1e3, (i + 0.5) / 40);
    points.push_back({I, friction(logarithm, truth, I) + (i % 2 == 0 ? 0.005 : -0.005), 0, 0.005});
  }
  const CalibratedLaw law = calibrated({points}, logarithm, 100);
  for (FrictionPoint& point : points) point.mu += 0.05;
  points.push_back({0.5, 0.4, 0, 0.005});
  const LawScore score = score_of("other", points, law);
  EXPECT_NEAR(score.bias, 0.05, 1e-3);
  EXPECT_EQ(score.outside, 1u);
  EXPECT_EQ(score.inside_prediction, 0);
}

}  // namespace
}  // namespace drumlin
