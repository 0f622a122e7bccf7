// The law with k at a point.
#include "continuum/rheology/turned_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "continuum/rheology/nonlocal_law.hpp"
#include "continuum/rheology/spin.hpp"

namespace drumlin::turned_law {
using namespace continuum;
namespace {

const LogLaw paper{0.35, 0.013};
const Regularisation none{1e-14, 1e-12};

struct Axes {
  double c = 1, s = 0;  ///< cosine and sine of the angle from x towards z
};
/// Components in axes turned by the angle of `axes`.
PlaneTensor seen_from(const Axes& axes, const PlaneTensor& a) {
  const auto [c, s] = axes;
  return {c * c * a.xx + 2 * c * s * a.xz + s * s * a.zz, s * s * a.xx - 2 * c * s * a.xz + c * c * a.zz,
          c * s * (a.zz - a.xx) + (c * c - s * s) * a.xz};
}

double distance(const PlaneTensor& a, const PlaneTensor& b) { return magnitude(a - b); }

StressRatioLaw bump() { return StressRatioLaw({1e-5, 1e-3, 1e-2}, {0.8, 1.2, 1.0}); }

TEST(ShearState, SolvesItsEquationAtEveryRate) {
  const StressRatioLaw law = bump();
  for (double rate = 1e-9; rate < 10; rate *= 1.3)
    for (const double p : {0.1, 3.0, 60.0}) {
      const ShearState at = shear_state(law, rate, p);
      EXPECT_NEAR(at.I / (2 * rate / std::sqrt(2 * p / (1 + at.k))), 1, 1e-12);
      EXPECT_NEAR(at.k, law.at_ln(std::log(at.I)).value, 1e-13);
    }
}

TEST(ShearState, SolvesItsEquationForTheSteepestTables) {
  // One e-fold of I at nearly dk/dln I = 1 + k, falling as steeply as one likes.
  for (const double top : {2.2, 1e-3})
    for (double rate = 1e-3; rate < 3e-2; rate *= 1.003) {
      const StressRatioLaw law({1e-2, 1e-2 * std::exp(1.0)}, {0.6, top});
      const ShearState at = shear_state(law, rate, 1);
      EXPECT_NEAR(at.I / (2 * rate / std::sqrt(2 / (1 + at.k))), 1, 1e-12) << rate;
    }
}

TEST(TurnedLaw, SimpleShearCarriesExactlyMuAndK) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const StressRatioLaw law({1e-6, 1e-4, 1e-2, 1}, {0.5 + unit(random), 0.5 + unit(random),
                                                     0.5 + unit(random), 0.5 + unit(random)});
    const LogLaw mu{0.2 + 0.3 * unit(random), 0.02 * unit(random)};
    const double p = std::exp(6 * unit(random) - 2), shear_rate = std::exp(-12 * unit(random));
    const PlaneTensor D{0, 0, 0.5 * shear_rate};
    const auto s = turned_response(mu, LocalRatio{&law, 1}, none, D, p, D);
    const double sigma_xx = p - s.stress.xx, sigma_zz = p - s.stress.zz;
    const double I = shear_rate / std::sqrt(sigma_zz);
    EXPECT_NEAR(sigma_xx / sigma_zz, law.at_ln(std::log(I)).value, 1e-11);
    EXPECT_NEAR(s.stress.xz / sigma_zz, mu.friction(I).mu, 1e-11);
    EXPECT_NEAR(s.at.I, I, 1e-11 * I);
    // Axes of stress against those of D: tan 2 delta = (k - 1)/(2 mu).
    const double k = s.at.k;
    EXPECT_NEAR(-0.5 * (s.stress.xx - s.stress.zz) / s.stress.xz, (k - 1) / (2 * mu.friction(I).mu), 1e-10);
  }
}

TEST(TurnedLaw, TheOtherSenseOfShearHasTheSameNormalStresses) {
  const StressRatioLaw law = bump();
  const PlaneTensor D{0, 0, 0.01};
  const auto forth = turned_response(paper, LocalRatio{&law, 1}, none, D, 4, D).stress;
  const auto back = turned_response(paper, LocalRatio{&law, -1}, none, -1.0 * D, 4, -1.0 * D).stress;
  EXPECT_NEAR(forth.xx, back.xx, 1e-14);
  EXPECT_NEAR(forth.zz, back.zz, 1e-14);
  EXPECT_NEAR(forth.xz, -back.xz, 1e-14);
}

TEST(TurnedLaw, OfKOneIsTheLawWithoutK) {
  const StressRatioLaw one({1e-3}, {1});
  const Regularisation smooth{0.05, 0.3};
  const PlaneTensor D{0.03, -0.03, 0.11}, dD{0.5, -0.2, 0.7};
  const PlaneTensor dual = (1 / regularised_rate(D, smooth)) * D;
  const auto with = turned_response(paper, LocalRatio{&one, 0.7}, smooth, D, 2, dual);
  const auto without = stress_response(paper, smooth, D, 2, dual);
  EXPECT_LT(distance(with.stress, without.stress), 1e-14);
  EXPECT_LT(distance(with.by_pressure, without.by_pressure), 1e-14);
  EXPECT_LT(distance(tangent(with, dD), tangent(without, dD)), 1e-13);
}

template <class Law>
void expect_tangent_of_stress(const Law& mu, const LocalRatio& ratio, double size, double p) {
  const Regularisation smooth{0.002, 0.3};
  const PlaneTensor dD{0.5, -0.2, 0.7}, D = size * PlaneTensor{0.03, -0.04, 0.9};
  const double h = 1e-7;
  const PlaneTensor dual = (1 / regularised_rate(D, smooth)) * D;
  const auto at = [&](double s, double t) {
    return turned_response(mu, ratio, smooth, D + s * size * dD, p + t, dual).stress;
  };
  const auto s = turned_response(mu, ratio, smooth, D, p, dual);
  const PlaneTensor by_D = (1 / (2 * h * size)) * (at(h, 0) - at(-h, 0)),
                    by_p = (1 / (2 * h)) * (at(0, h) - at(0, -h));
  // Central differences: rounding 1e-16/h, curvature of the table h^2 and, at its points, h.
  EXPECT_LT(distance(tangent(s, dD), by_D), 1e-6 * magnitude(by_D)) << size << " " << p;
  EXPECT_LT(distance(s.by_pressure, by_p), 1e-6 * magnitude(by_p)) << size << " " << p;
}

TEST(TurnedLaw, TangentIsTheDerivativeOfTheStress) {
  const StressRatioLaw law = bump();
  for (const double size : {2e-4, 2e-3, 0.05})  // I on the rise, on the fall of k, beyond the table
    for (const double p : {-0.5, 0.2, 5.0})
      for (const double turn : {1.0, -0.6, 0.0}) {
        expect_tangent_of_stress(paper, LocalRatio{&law, turn}, size, p);
        expect_tangent_of_stress(NonlocalLaw<LogLaw>{paper, 0.03}, LocalRatio{&law, turn}, size, p);
      }
}

TEST(TurnedLaw, DissipatesTwicePMTimesTheRateHoweverItIsTurned) {
  const StressRatioLaw law = bump();
  for (int i = 0; i < 200; ++i) {
    const double stretch = std::cos(2.0 * i), p = 3;
    const PlaneTensor D{stretch, -stretch, std::sin(3.0 * i + 1)};
    const auto s = turned_response(paper, LocalRatio{&law, std::sin(5.0 * i)}, none, D, p, D);
    const double M = 2 * paper.friction(s.at.I).mu / (1 + s.at.k);
    EXPECT_NEAR(contraction(s.stress, D), 2 * p * M * magnitude(D), 1e-12 * p * magnitude(D));
  }
}

// A steady flow whose axes of strain rate turn along the paths, and the point of view of an observer who
// turns.
struct Motion {
  double x = 0.4, z = -0.7;
  double vx() const { return std::sin(1.3 * z) + 0.4 * x * z; }
  double vz() const { return 0.3 * std::cos(0.9 * x) - 0.2 * z * z; }
  PlaneTensor D() const {
    const double xx = 0.4 * z, zz = -0.4 * z, by_z = 1.3 * std::cos(1.3 * z) + 0.4 * x,
                 by_x = -0.27 * std::sin(0.9 * x);
    return {xx, zz, 0.5 * (by_z + by_x)};
  }
  double spin() const { return 0.5 * (1.3 * std::cos(1.3 * z) + 0.4 * x + 0.27 * std::sin(0.9 * x)); }
  Motion after(double t) const { return {x + t * vx(), z + t * vz()}; }
};

TEST(TurnedLaw, StressTurnsWithTheAxesOfATurningObserverAndNothingElseChanges) {
  const StressRatioLaw law = bump();
  const Motion here;
  const double h = 1e-5;
  const auto stress_seen = [&](double angle, double observer_spin, double& turn) {
    // The axes stand at `angle` now and turn on: D_dot has a part from that, and the spin of the material
    // relative to them gains what they turn (counted from x towards z, hence dv_x/dz falls when they turn
    // that way).
    const auto axes_at = [&](double t) {
      const double now = angle + observer_spin * t;
      return Axes{std::cos(now), std::sin(now)};
    };
    const PlaneTensor D = seen_from(axes_at(0), here.D());
    const PlaneTensor D_dot = (1 / (2 * h)) * (seen_from(axes_at(h), here.after(h).D()) -
                                               seen_from(axes_at(-h), here.after(-h).D()));
    const double rate = magnitude(D);
    turn = turn_of(here.spin() + observer_spin - eigenframe_spin(D, D_dot, rate), rate);
    return turned_response(paper, LocalRatio{&law, turn}, none, D, 2, D).stress;
  };
  double turn_at_rest = 0, turn = 0;
  const PlaneTensor at_rest = stress_seen(0, 0, turn_at_rest);
  EXPECT_GT(std::abs(turn_at_rest), 0.1);
  for (const double angle : {0.0, 0.7, 2.5})
    for (const double spin : {0.0, 0.3, -4.0}) {
      const PlaneTensor seen = stress_seen(angle, spin, turn);
      EXPECT_NEAR(turn, turn_at_rest, 1e-8);  // h^2 of the differences
      EXPECT_LT(distance(seen, seen_from({std::cos(angle), std::sin(angle)}, at_rest)), 1e-8);
    }
}

TEST(TurnOf, IsOneInSimpleShearAndNoughtInPureExtension) {
  EXPECT_NEAR(turn_of(0.5, 0.5), 1, 1e-15);
  EXPECT_NEAR(turn_of(-0.5, 0.5), -1, 1e-15);
  EXPECT_EQ(turn_of(0, 0.5), 0);
  EXPECT_LT(turn_of(1e9, 0.5), 1.01);  // sqrt(1 + c^2)
}

}  // namespace
}  // namespace drumlin::turned_law
