// The law with memory of the axes at a point.
#include "continuum/rheology/memory_stress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace drumlin {
using namespace continuum;
namespace {

using Complex = std::complex<double>;

const LogLaw mu{0.3, 0.013};
const Regularisation soft{0.05, 0.3};

struct Point {
  PlaneTensor D;
  double p = 1, m = 1;
  Remembered held;
};

// Rates about the regularised one and far above it, memory of any direction and amount.
class Points {
 public:
  Point next() {
    const double rate = std::exp(8 * unit_(random_) - 6), angle = 2 * std::numbers::pi * unit_(random_);
    const Complex A = std::polar(unit_(random_), 2 * std::numbers::pi * unit_(random_));
    return {as_tensor(std::polar(rate, angle)),
            std::exp(4 * unit_(random_) - 1),
            unit_(random_),
            {A.real(), A.imag(), 0.3 + 1.7 * unit_(random_)}};
  }

 private:
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> unit_{0, 1};
};

MemoryResponse response_at(const Point& at, const PlaneTensor& D, double p) {
  const double rate = regularised_rate(D, soft);
  return memory_response(mu, at.m, at.held, soft, D, p, (1 / rate) * D);
}
MemoryResponse response_at(const Point& at) { return response_at(at, at.D, at.p); }

TEST(MemoryStress, IsThatOfMuWithoutWeight) {
  Points points;
  for (int trial = 0; trial < 100; ++trial) {
    Point at = points.next();
    at.m = 0;
    at.held.rho = rho_target(0, as_complex(at.D) / regularised_rate(at.D, soft), {at.held.xx, at.held.xz});
    EXPECT_EQ(at.held.rho, 1);
    const double rate = regularised_rate(at.D, soft);
    const PlaneTensor expected = stress_response(mu, soft, at.D, at.p, (1 / rate) * at.D).stress;
    EXPECT_LE(magnitude(response_at(at).stress - expected), 1e-15 * magnitude(expected));
  }
}

TEST(MemoryStress, AmountIsMuOfIWhateverTheAxes) {
  const Regularisation none{1e-14, 1e-12};
  Points points;
  for (int trial = 0; trial < 100; ++trial) {
    Point at = points.next();
    const Complex n = as_complex(at.D) / magnitude(at.D), A(at.held.xx, at.held.xz);
    at.held.rho = rho_target(at.m, n, A);
    if (at.held.rho <= least_rho) continue;
    const auto s = memory_response(mu, at.m, at.held, none, at.D, at.p, (1 / magnitude(at.D)) * at.D);
    EXPECT_NEAR(magnitude(s.stress) / at.p, mu.friction(2 * magnitude(at.D) / std::sqrt(at.p)).mu, 1e-12);
  }
}

TEST(MemoryStress, NeverGivesWorkBack) {
  Points points;
  for (int trial = 0; trial < 2000; ++trial) {
    Point at = points.next();
    at.m = 1;
    if (trial % 2 == 0) {  // memory of the opposite strain, as much of it as there can be
      const Complex opposite = -as_complex(at.D) / magnitude(at.D);
      at.held = {opposite.real(), opposite.imag(), least_rho};
    }
    EXPECT_GE(contraction(response_at(at).stress, at.D), 0);
    // What the past adds to the amount may ask for more than all of the friction.
    const FollowedLaw<LogLaw> followed{mu, 0.02, trial % 3 == 0 ? -1.0 : 0.1};
    const PlaneTensor dual = (1 / regularised_rate(at.D, soft)) * at.D;
    const auto s = memory_response(followed, at.m, at.held, soft, at.D, at.p, dual);
    EXPECT_GE(contraction(s.stress, at.D), 0);
  }
}

TEST(MemoryStress, FollowsTheRateAndThePressureWithCreepAndOwnWeight) {
  struct Case {
    double spin, own_weight;
  };
  for (const auto& [spin, own_weight] : {Case{0, 0}, {0.3, 0}, {30, 0}, {30, 4}, {0, 0.5}}) {
    const FollowedLaw<LogLaw> law{mu, 0.02, 0.1, {.slope = 0.015, .ratio = 0.5}, spin, own_weight};
    const double rate = 0.2, p = 3, h = 1e-6;
    const Strength at = strength(law, rate, p);
    EXPECT_NEAR(at.d_rate, (strength(law, rate + h, p).value - strength(law, rate - h, p).value) / (2 * h),
                1e-7);
    EXPECT_NEAR(at.d_pressure,
                (strength(law, rate, p + h).value - strength(law, rate, p - h).value) / (2 * h), 1e-7);
    const double I = 2 * rate / std::sqrt(p + own_weight);
    EXPECT_NEAR(at.value / p - creep_friction(law.creep, rate, spin),
                mu.friction(I).mu + 0.02 * std::log(I) + 0.1, 1e-5);  // as far as both are kept positive
  }
}

TEST(MemoryStress, IsTheSameForATurnedObserver) {
  Points points;
  for (int trial = 0; trial < 100; ++trial) {
    const Point at = points.next();
    const Complex turn = std::polar(1.0, 0.7 * trial);
    Point seen = at;
    seen.D = as_tensor(turn * as_complex(at.D));
    const Complex A = turn * Complex(at.held.xx, at.held.xz);
    seen.held = {A.real(), A.imag(), at.held.rho};
    const auto here = response_at(at), there = response_at(seen);
    EXPECT_NEAR(std::abs(turn * as_complex(here.stress) - as_complex(there.stress)), 0, 1e-13 * at.p);
    EXPECT_NEAR(well_posedness_margin(here), well_posedness_margin(there), 1e-12);
  }
}

TEST(MemoryStress, TangentIsItsDerivative) {
  Points points;
  for (int trial = 0; trial < 200; ++trial) {
    const Point at = points.next();
    const MemoryResponse s = response_at(at);
    const double h = 1e-6 * s.rate;
    for (const PlaneTensor& e : {PlaneTensor{1, 0, 0}, PlaneTensor{0, 1, 0}, PlaneTensor{0, 0, 1}}) {
      const PlaneTensor difference =
          1 / (2 * h) *
          (response_at(at, at.D + h * e, at.p).stress - response_at(at, at.D - h * e, at.p).stress);
      EXPECT_LE(magnitude(difference - tangent(s, e)), 1e-7 * s.modulus);
    }
    const double hp = 1e-6 * at.p;
    const PlaneTensor by_p =
        1 / (2 * hp) * (response_at(at, at.D, at.p + hp).stress - response_at(at, at.D, at.p - hp).stress);
    EXPECT_LE(magnitude(by_p - s.by_pressure), 1e-7);
  }
}

// The symbol of a wave from the tangent itself, times the factor that the margin is taken with: a wave whose
// normal k keeps the balance along k by its pressure, and grows along the layers t.
double symbol(const MemoryResponse& s, double angle) {
  const double kx = std::cos(angle), kz = std::sin(angle), tx = -kz, tz = kx;
  const PlaneTensor strain{tx * kx, tz * kz, 0.5 * (tx * kz + tz * kx)};
  const auto between = [](double ax, double az, const PlaneTensor& a, double bx, double bz) {
    return ax * (a.xx * bx + a.xz * bz) + az * (a.xz * bx + a.zz * bz);
  };
  const PlaneTensor dtau = tangent(s, strain);
  const double left = 1 - between(kx, kz, s.by_pressure, kx, kz);
  const double dp = between(kx, kz, dtau, kx, kz) / left;
  const double growth = between(tx, tz, dtau + dp * s.by_pressure, kx, kz);
  return left * growth / (0.5 * s.modulus);
}

TEST(MemoryStress, MarginIsTheLeastOfItsSymbol) {
  Points points;
  int ill_posed = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const MemoryResponse s = response_at(points.next());
    const double margin = well_posedness_margin(s);
    if (margin == -1) continue;  // pressure cannot balance the wave
    double least = INFINITY;
    for (int i = 0; i < 4000; ++i) least = std::min(least, symbol(s, std::numbers::pi * i / 4000));
    EXPECT_NEAR(margin, least, 1e-5);  // the grid misses the least by the square of its angle
    ill_posed += margin < 0;
  }
  EXPECT_GT(ill_posed, 5);  // so that both signs were met
}

}  // namespace
}  // namespace drumlin
