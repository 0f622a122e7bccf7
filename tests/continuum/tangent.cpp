// The assembled tangent against differences of the assembled residual.
#include <gtest/gtest.h>

#include "tangent_error.hpp"

namespace drumlin {
using namespace continuum;
namespace {

using namespace testing_tangent;

TEST(AssembledTangent, IsTheDerivativeOfTheResidualWithKAndNonlocalFluidity) {
  FlowProblem problem = small_segment();
  EXPECT_LT(tangent_error(problem, false, 1e-6), 1e-7);
  problem.turned = TurnedStress{.k = StressRatioLaw({0.05, 20}, {0.7, 1.3})};
  EXPECT_LT(tangent_error(problem, false, 1e-6), 1e-7);
  problem.nonlocal = NonlocalFluidity{.length = 1.5};
  EXPECT_LT(tangent_error(problem, false, 1e-6), 1e-7);
  problem.turned.reset();
  EXPECT_LT(tangent_error(problem, false, 1e-6), 1e-7);
}

TEST(AssembledTangent, KnowsAStrengthThatThePressureDecidesToo) {
  FlowProblem problem = small_segment();
  problem.law = CohesiveLaw{0.7, 0.3, 1.1};
  EXPECT_LT(tangent_error(problem, false, 1e-6), 1e-7);
}

TEST(AssembledTangent, KnowsInertiaATurningFrameAndAWallWithFriction) {
  FlowProblem problem = small_segment();
  problem.frame = RotatingFrame{0.3, 0.5};
  problem.boundary[Side::bottom] = FrictionWall{.velocity =
                                                    [](Vec2 x) {
                                                      return Vec2{0.2 * x.z, -0.2 * x.x};
                                                    },
                                                .friction = 0.5,
                                                .slip_speed = 0.3};
  EXPECT_LT(tangent_error(problem, true, 1e-6), 1e-7);
}

}  // namespace
}  // namespace drumlin
