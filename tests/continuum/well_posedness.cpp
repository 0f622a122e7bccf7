#include "continuum/rheology/well_posedness.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace drumlin {
namespace {

// Unit pressure: I = 2 |D|.
bool well_posed(const StressLaw& law, double I) {
  return well_posedness_margin(strength(law, 0.5 * I, 1), 0.5 * I) >= 0;
}

// Barker, Schaeffer, Bohorquez & Gray, J. Fluid Mech. 779 (2015), eq. (1.7) for two dimensions.
template <class Law>
bool barker(const Law& law, double I) {
  const Friction f = law.friction(I);
  const double y = f.slope / f.mu, half = f.mu * (1 - 0.5 * y);
  return 4 * y * y - 4 * y + half * half <= 0;
}

TEST(WellPosedness, IsTheConditionOfBarkerEtAlForEveryInertialNumber) {
  const LogLaw paper{0.35, 0.013};
  const SaturatingLaw jop{0.383, 0.643, 0.279};
  for (double log_I = -8; log_I < 2; log_I += 0.01) {
    const double I = std::pow(10, log_I);
    EXPECT_EQ(well_posed(paper, I), barker(paper, I)) << I;
    EXPECT_EQ(well_posed(jop, I), barker(jop, I)) << I;
  }
}

TEST(WellPosedness, HoldsForThePapersLawWithTheNaturalLogarithm) {
  const LogLaw natural{0.35, 0.013};
  for (const double I : {1e-7, 1e-4, 1e-1, 3.0}) EXPECT_TRUE(well_posed(natural, I)) << I;
  EXPECT_FALSE(well_posed(natural, 10));
}

TEST(WellPosedness, FailsForThePapersLawWithTheDecimalLogarithm) {
  const LogLaw decimal{0.35, 0.013 / std::log(10.0)};
  EXPECT_TRUE(well_posed(decimal, 5e-6));
  for (const double I : {2e-5, 1e-3, 1e-1}) EXPECT_FALSE(well_posed(decimal, I)) << I;
}

TEST(WellPosedness, HoldsForJopsLawInItsMiddleRangeOnly) {
  const SaturatingLaw jop{0.383, 0.643, 0.279};
  EXPECT_FALSE(well_posed(jop, 0.018));
  EXPECT_TRUE(well_posed(jop, 0.022));
  EXPECT_TRUE(well_posed(jop, 0.82));
  EXPECT_FALSE(well_posed(jop, 0.88));
}

TEST(WellPosedness, HoldsForANewtonianFluid) {
  EXPECT_GT(well_posedness_margin(strength(NewtonianLaw{3}, 0.5, 1), 0.5), 0);
}

TEST(WellPosedness, RegularisedRigidPartsAreWellPosed) {
  // |D| far below eps: the law is a fluid of constant viscosity there, whatever its friction does.
  const LogLaw decimal{0.35, 0.013 / std::log(10.0)};
  EXPECT_GT(well_posedness_margin(strength(decimal, 0.5e-3, 1), 0.5e-3, 0.01), 0);
}

}  // namespace
}  // namespace drumlin
