#include "coupling/calibration/centre_friction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "coupling/core/law/law_curve.hpp"

namespace drumlin {
using namespace coupling;
namespace {

/// Twenty layers whose mu is a + b ln I, without intervals; z from -22 to -3 above a wall at -40.
ProfileSet profile(double a, double b) {
  ProfileSet profiles;
  profiles.header.wall_z = -40;
  ProfileColumn I{"I", {}, {}}, mu{"mu", {}, {}};
  for (int layer = 0; layer < 20; ++layer) {
    profiles.z.push_back(-22 + layer);
    I.value.push_back(2e-4 * std::pow(400, layer / 19.0));
    mu.value.push_back(a + b * std::log(I.value.back()));
  }
  profiles.columns = {I, mu};
  return profiles;
}

TEST(CentreFriction, ItsIntervalsAddTheSpreadOfThePartsToThatOfTheFit) {
  // On the law to rounding: the fit has no error of its own. Parts that move a alone leave b certain.
  const std::vector<ProfileSet> parts{profile(0.36, 0.014), profile(0.38, 0.014), profile(0.36, 0.014),
                                      profile(0.38, 0.014)};
  const CentreFriction friction = centre_friction(profile(0.37, 0.014), parts, 5.84, {});
  EXPECT_NEAR(friction.law.a, 0.37, 1e-9);
  // Jackknife of four values +- 0.01 whose neighbours differ: sqrt(3/4 * 4e-4).
  EXPECT_NEAR(friction.scalars.find("mu_a")->ci99.value(), 5.84 * std::sqrt(3e-4), 1e-6);
  EXPECT_NEAR(friction.scalars.find("mu_b")->ci99.value(), 0, 1e-6);
}

TEST(CentreFriction, TooFewLayersGiveNoLaw) {
  LayerSelection nothing;
  nothing.I_min = 1, nothing.I_max = 2;
  EXPECT_TRUE(std::isnan(centre_friction(profile(0.37, 0.014), {}, std::nan(""), nothing).law.a));
}

TEST(LawCurve, RunsThroughTheLawFromEndToEnd) {
  const FrictionLaw law = LogLaw{.a = 0.36, .b = 0.014};
  const LawCurve curve = law_curve(law, 1e-4, 1e-1);
  ASSERT_EQ(curve.I.size(), 41u);
  EXPECT_DOUBLE_EQ(curve.I.front(), 1e-4);
  EXPECT_NEAR(curve.I.back(), 1e-1, 1e-15);
  for (std::size_t i = 0; i < curve.I.size(); ++i) EXPECT_EQ(curve.mu[i], friction_at(law, curve.I[i]).mu);
}

}  // namespace
}  // namespace drumlin
