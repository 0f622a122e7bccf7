#include "continuum/reference/closed_forms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace drumlin {
namespace {

const LogLaw paper{0.35, 0.013};
constexpr double degree = std::numbers::pi / 180;

TEST(Bagnold, SurfaceSpeedsOfTheDesign) {
  EXPECT_NEAR(bagnold_speed(paper, 0.82, 18 * degree, 20, 20), 7.649, 1e-3);
  EXPECT_NEAR(bagnold_speed(paper, 0.82, 18.5 * degree, 20, 20), 16.077, 1e-3);
  EXPECT_NEAR(bagnold_speed(paper, 0.82, 19 * degree, 20, 20), 33.939, 1e-3);
}

TEST(Bagnold, ObeysTheLawAtEveryHeight) {
  const double theta = 18.3 * degree, H = 12, h = 1e-5;
  for (const double z : {1.0, 6.0, 11.0}) {
    const double rate =
        (bagnold_speed(paper, 0.82, theta, H, z + h) - bagnold_speed(paper, 0.82, theta, H, z - h)) / (2 * h);
    const double p = 0.82 * std::cos(theta) * (H - z);
    EXPECT_NEAR(paper.friction(rate / std::sqrt(p)).mu, std::tan(theta),
                1e-5);  // the floor of mu moves it by 3e-6
  }
}

TEST(PlaneShear, RateBelongsToTheStress) {
  EXPECT_NEAR(plane_shear_rate(paper, 4, 4 * (0.35 + 0.013 * std::log(0.01))), 0.02, 1e-12);
}

TEST(VerticalChute, ObeysTheLawAcrossIt) {
  const double nu = 0.8, P = 5, W = 2, h = 1e-6;
  for (const double y : {1.2, 1.6, 1.95}) {
    const double rate =
        -(vertical_chute_speed(paper, nu, P, W, y + h) - vertical_chute_speed(paper, nu, P, W, y - h)) /
        (2 * h);
    EXPECT_NEAR(paper.a + paper.b * std::log(rate / std::sqrt(P)), nu * y / P, 1e-6);
  }
}

}  // namespace
}  // namespace drumlin
