#include "coupling/core/results/plane_invariants.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace drumlin {
namespace {

TEST(AxisAngle, SimpleShearTurnsTheStressByTheRatioOfNormalStresses) {
  const PlaneMatrix shear{0, 0.2, 0, 0};
  for (double k : {0.8, 1.0, 1.2})
    for (double mu : {0.2, 0.4}) {
      const PlaneMatrix pressure{k, -mu, -mu, 1};
      EXPECT_NEAR(std::tan(2 * axis_angle_deg(pressure, shear) * std::numbers::pi / 180), (k - 1) / (2 * mu),
                  1e-12);
    }
}

PlaneMatrix turned(const PlaneMatrix& t, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * c * t.xx - c * s * (t.xz + t.zx) + s * s * t.zz,
          c * c * t.xz - s * s * t.zx + c * s * (t.xx - t.zz),
          c * c * t.zx - s * s * t.xz + c * s * (t.xx - t.zz),
          s * s * t.xx + c * s * (t.xz + t.zx) + c * c * t.zz};
}

TEST(AxisAngle, DoesNotDependOnTheAxesOrOnSpinAndPressure) {
  const PlaneMatrix pressure{1.1, -0.3, -0.35, 0.9}, gradient{0.05, 0.2, 0.02, -0.04};
  const double angle = axis_angle_deg(pressure, gradient);
  for (double turn = 0; turn < 6.3; turn += 0.3)
    EXPECT_NEAR(axis_angle_deg(turned(pressure, turn), turned(gradient, turn)), angle, 1e-10);
  EXPECT_NEAR(axis_angle_deg({3.1, -0.3, -0.35, 2.9}, gradient), angle, 1e-12);
  EXPECT_NEAR(axis_angle_deg(pressure, {0.05, 0.9, -0.68, -0.04}), angle, 1e-12);
  EXPECT_NEAR(axis_angle_deg(turned(pressure, 0.2), gradient), angle + 0.2 * 180 / std::numbers::pi, 1e-10);
}

TEST(PlaneInvariants, SimpleShearUnderPressureHasThoseOfTheProfiles) {
  const double mu = 0.3, sigma_zz = 4, shear_rate = 0.2;
  const PlaneInvariants at =
      plane_invariants({sigma_zz, -mu * sigma_zz, -mu * sigma_zz, sigma_zz}, {0, shear_rate, 0, 0});
  EXPECT_NEAR(at.strain_rate, shear_rate, 1e-15);
  EXPECT_NEAR(at.half_vorticity, shear_rate / 2, 1e-15);
  EXPECT_NEAR(at.p, sigma_zz, 1e-15);
  EXPECT_NEAR(at.mu, mu, 1e-15);
  EXPECT_NEAR(at.I, shear_rate / 2, 1e-15);
  EXPECT_NEAR(at.k, 1, 1e-15);
  EXPECT_NEAR(at.axis_angle_deg, 0, 1e-13);
}

TEST(PlaneInvariants, UnderTensionHaveNoRatios) {
  const PlaneInvariants at = plane_invariants({-1, 0.2, 0.2, -1}, {0, 0.2, 0, 0});
  EXPECT_NEAR(at.p, -1, 1e-15);
  EXPECT_NEAR(at.tau, 0.2, 1e-15);
  for (const double none : {at.I, at.mu, at.k, at.axis_angle_deg}) EXPECT_TRUE(std::isnan(none));
}

}  // namespace
}  // namespace drumlin
