#include "continuum/reference/closed_forms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace drumlin::closed_forms {
using namespace continuum;
namespace {

const LogLaw paper{0.35, 0.013};
constexpr double degree = std::numbers::pi / 180;

TEST(PlaneShear, RateBelongsToTheStress) {
  EXPECT_NEAR(plane_shear_rate(paper, 4, 4 * (0.35 + 0.013 * std::log(0.01))), 0.02, 1e-12);
}

const StressLaw jop = JopLaw{0.383, 0.643, 0.279};
const StressLaw table = TabulatedLaw({1e-4, 1e-3, 1e-2, 0.1}, {0.22, 0.27, 0.29, 0.34});
const StressLaw logarithm = paper;

TEST(InertialNumber, UndoesEveryLaw) {
  for (const StressLaw& law : {jop, table, logarithm})
    for (double I = 1e-5; I < 10; I *= 1.7)
      EXPECT_NEAR(inertial_number(law, strength(law, 0.5 * I, 1).value) / I, 1, 1e-11);
}

TEST(InertialNumber, IsNoughtBelowTheYieldFrictionAndInfiniteAboveTheLargest) {
  EXPECT_EQ(inertial_number(jop, 0.38), 0);
  EXPECT_EQ(inertial_number(jop, 0.65), std::numeric_limits<double>::infinity());
  EXPECT_EQ(inertial_number(StressLaw(ConstantLaw{0.3}), 0.29), 0);
  EXPECT_EQ(inertial_number(StressLaw(ConstantLaw{0.3}), 0.31), std::numeric_limits<double>::infinity());
}

TEST(ClosedFormsForAnyLaw, AreThoseOfTheLogarithm) {
  // The floor of mu, which the closed forms leave out, moves I by m^2/(mu b) = 3e-4 of itself at most here.
  EXPECT_NEAR(bagnold_speed(logarithm, 0.82, 18 * degree, 20, 20),
              bagnold_speed(paper, 0.82, 18 * degree, 20, 20), 3e-4 * 7.7);
  EXPECT_NEAR(plane_shear_rate(logarithm, 4, 1.2) / plane_shear_rate(paper, 4, 1.2), 1, 3e-4);
  EXPECT_NEAR(vertical_chute_speed(logarithm, 0.8, 5, 2, 1.4) / vertical_chute_speed(paper, 0.8, 5, 2, 1.4),
              1, 3e-4);
}

TEST(VerticalChute, OfJopsLawHasAPlugUpToItsYieldFriction) {
  const double nu = 0.8, P = 2, W = 1.5, edge = 0.383 * P / nu;
  // To the accuracy of the integral.
  EXPECT_NEAR(vertical_chute_speed(jop, nu, P, W, 0), vertical_chute_speed(jop, nu, P, W, 0.5 * edge), 1e-9);
  // I = I_0 (mu - mu_s)/(mu_2 - mu), integrated by hand with mu = nu y/P.
  const double mu_W = nu * W / P,
               by_hand = std::sqrt(P) * P / nu * 0.279 *
                         ((0.643 - 0.383) * std::log((0.643 - 0.383) / (0.643 - mu_W)) - (mu_W - 0.383));
  EXPECT_NEAR(vertical_chute_speed(jop, nu, P, W, edge), by_hand, 1e-8 * by_hand);
}

TEST(DrumCentre, SlopesOfTheDesign) {
  // Half-filled drums, Q = nu Omega R^2/2, and profiles that decay over l = 3.4.
  const double kappa = 2 * paper.b / 3.4, Q_of_6rpm = 21.97;
  EXPECT_NEAR(drum_centre_slope(paper, 0.82, kappa, Q_of_6rpm) / degree, 19.34, 0.005);
  EXPECT_NEAR(drum_centre_slope(paper, 0.82, kappa, Q_of_6rpm / 3) / degree, 18.60, 0.005);
  EXPECT_NEAR(drum_centre_slope(paper, 0.82, kappa, Q_of_6rpm * 2.5) / degree, 19.94, 0.005);
}

TEST(DrumCentre, RateIsThatOfTheLogarithm) {
  const DrumCentre centre{0.82, 2 * paper.b / 3.4, 19.34 * degree};
  const double I0 = inertial_number(paper, std::tan(centre.theta));
  for (const double y : {0.5, 4.0, 20.0})  // relative error of I by the floor of mu: m^2/(mu b)
    EXPECT_NEAR(drum_centre_rate(logarithm, centre, y) /
                    (I0 * std::sqrt(0.82 * std::cos(centre.theta) * y) * std::exp(-y / 3.4)),
                1, 5e-4);
  EXPECT_NEAR(drum_centre_flux(logarithm, centre) / drum_centre_flux(paper, centre), 1, 3e-4);
}

TEST(DrumCentre, FluxIsTheIntegralOfTheSpeedForAnyLaw) {
  const DrumCentre centre{0.8, 0.01, 19 * degree};
  double sum = 0;  // by the midpoints; the speed ends at 2 tan(theta)/kappa = 68.9
  for (double y = 0.5; y < 68.8; ++y) sum += drum_centre_speed(table, centre, y);
  EXPECT_NEAR(0.8 * sum / drum_centre_flux(table, centre), 1, 2e-3);
}

TEST(DrumCentre, WithoutAGradientOfKIsBagnoldsFlow) {
  const double theta = 18.5 * degree, H = 20, y = 7, h = 1e-4;
  const double bagnold =
      (bagnold_speed(table, 0.82, theta, H, H - y + h) - bagnold_speed(table, 0.82, theta, H, H - y - h)) /
      (2 * h);
  EXPECT_NEAR(drum_centre_rate(table, {0.82, 0, theta}, y) / bagnold, 1, 1e-7);
}

}  // namespace
}  // namespace drumlin::closed_forms
