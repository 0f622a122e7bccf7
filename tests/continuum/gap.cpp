// Flows across a gap from scenes, and their solution by quadrature against what can be written down.
#include "continuum/model/gap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "continuum/reference/closed_forms.hpp"
#include "continuum/reference/gap_solution.hpp"
#include "coupling/core/basics/errors.hpp"
#include "tests/support/says.hpp"

namespace drumlin::gap {
using namespace continuum;
namespace {

constexpr double degree = std::numbers::pi / 180, nu = 0.82;
constexpr Regularisation none{1e-14, 1e-9};
// LogLaw keeps mu positive, which moves mu = 0.3 by 3e-6, hence ln I by 3e-6/b = 3e-4.
constexpr double of_the_floor = 5e-4;
// The paper's, a weaker and a steeper law.
const std::vector<LogLaw> laws = {{0.35, 0.013}, {0.33, 0.013}, {0.35, 0.02}};

Gap incline(double theta_deg) { return {.depth = 20, .nu = nu, .weight = nu, .slope = theta_deg * degree}; }
Gap chute(double P) {
  return {.depth = 10, .nu = nu, .weight = nu, .slope = 90 * degree, .pressure = P, .flows_at_wall = true};
}
Gap plane_shear(double speed) { return {.depth = 20, .nu = nu, .pressure = 4, .speed = speed}; }
Gap annulus(double speed) {
  return {.depth = 20, .inner_radius = 20, .nu = nu, .pressure = 4, .speed = speed};
}

TEST(GapSolution, IsBagnoldsFlowForEveryLaw) {
  const std::vector<double> y = {0, 3, 10, 19};
  for (const LogLaw& law : laws) {
    const auto flow = gap_solution(incline(18.5), law, none, y);
    for (std::size_t k = 0; k < y.size(); ++k) {
      const double exact = bagnold_speed(law, nu, 18.5 * degree, 20, 20 - y[k]);
      EXPECT_NEAR(flow.speed[k], exact, of_the_floor * exact) << law.a << " " << law.b;
    }
    // Q of Bagnold's flow: 3/5 of the surface speed times the height.
    EXPECT_NEAR(flow.Q, nu * 0.6 * flow.top_speed * 20, 1e-6 * flow.Q);
  }
}

TEST(GapSolution, IsThePlugAndTheShearLayerOfAChuteForEveryLaw) {
  const std::vector<double> y = {0, 5, 9.2, 9.9};
  for (const LogLaw& law : laws) {
    const auto flow = gap_solution(chute(27), law, none, y);
    for (std::size_t k = 0; k < y.size(); ++k) {
      const double exact = vertical_chute_speed(law, nu, 27, 10, y[k]);
      EXPECT_NEAR(flow.speed[k], exact, of_the_floor * exact) << law.a << " " << law.b;
    }
  }
}

TEST(GapSolution, FindsTheShearStressOfADrivenPlate) {
  for (const LogLaw& law : laws) {
    const auto flow = gap_solution(plane_shear(0.4), law, none, {});
    EXPECT_NEAR(flow.top_shear_stress / 4, law.friction(0.01).mu, 1e-9);  // 0.4/20/sqrt(4)
    EXPECT_NEAR(flow.Q, nu * 0.5 * 0.4 * 20, 1e-9);
  }
}

TEST(GapSolution, IsAnnularCouetteFlowForEveryLaw) {
  const std::vector<double> y = {0, 0.3, 1, 5};
  for (const LogLaw& law : laws) {
    const auto flow = gap_solution(annulus(0.5), law, none, y);
    const double mu_i = flow.top_shear_stress / 4;
    for (std::size_t k = 0; k < y.size(); ++k) {
      const double exact = annular_couette_speed(law, 4, 20, 40, mu_i, 20 + y[k]);
      EXPECT_NEAR(flow.speed[k], exact, of_the_floor * exact) << law.a << " " << law.b;
    }
    EXPECT_NEAR(flow.speed[0], 0.5, 1e-8);
  }
}

TEST(GapSolution, TakesAnyLawAndItsRegularisation) {
  const JopLaw jop{0.383, 0.643, 0.279};
  // mu(I) = 0.5: I = 0.279 (0.5 - 0.383)/(0.643 - 0.5).
  const double I = 0.279 * 0.117 / 0.143;
  EXPECT_NEAR(shear_rate(jop, none, 9, 4.5), 3 * I, 1e-9);
  EXPECT_NEAR(shear_rate(jop, none, 9, 3.0), 0, 1e-12);  // below its threshold it rests
  // |D| far below eps: a fluid of the viscosity mu p/eps.
  EXPECT_NEAR(shear_rate(jop, {1e-2, 1e-9}, 9, 1e-4), 1e-4 * 1e-2 / (jop.friction(1e-2 / 3).mu * 9), 1e-9);
}

// Where tan(theta) p < c + mu_s p the layer is a plug, down to y_c; below, with s = sqrt(nu cos(theta)),
//   b shear_rate = (tan(theta) - mu_s) s y^0.5 - c y^-0.5/s.
TEST(GapSolution, IsThePlugOnTheShearLayerOfACohesiveIncline) {
  const std::vector<double> y = {0, 2, 5, 10, 19};
  const double theta = 25 * degree, s = std::sqrt(nu * std::cos(theta));
  for (const CohesiveLaw& law :
       {CohesiveLaw{0.5, 0.3, 1.1}, CohesiveLaw{0.2, 0.35, 0.4}, CohesiveLaw{0, 0.3, 1}}) {
    const double steep = std::tan(theta) - law.mu_s, y_c = law.c / (s * s * steep);
    const auto of = [&](double at) {  // integral of b shear_rate
      return 2.0 / 3 * steep * s * std::pow(at, 1.5) - 2 * law.c / s * std::sqrt(at);
    };
    const auto flow = gap_solution(incline(25), law, none, y);
    for (std::size_t k = 0; k < y.size(); ++k) {
      const double exact = (of(20) - of(std::max(y[k], y_c))) / law.b;
      EXPECT_NEAR(flow.speed[k], exact, 1e-5 * exact) << law.words() << " at " << y[k];
      const double rate =
          y[k] > y_c ? (steep * s * std::sqrt(y[k]) - law.c / (s * std::sqrt(y[k]))) / law.b : 0;
      EXPECT_NEAR(flow.shear_rate[k], rate, 1e-8 + 1e-8 * rate) << law.words() << " at " << y[k];
    }
  }
}

TEST(Gap, ComesInUnitsOfItsGrains) {
  const Scales scales = scales_of(3.3e-3, 9.81, 2700);
  const Gap shear = gap_of(FlowPlaneShear{66, 72, 350}, scales, nu);
  EXPECT_NEAR(shear.depth, 20, 1e-12);
  EXPECT_NEAR(shear.pressure, 350 / (2700 * 9.81 * 3.3e-3), 1e-12);
  EXPECT_NEAR(*shear.speed, 0.072 / std::sqrt(9.81 * 3.3e-3), 1e-12);
  const Gap ring = gap_of(FlowAnnulus{66, 132, 13, 350}, scales, nu);
  EXPECT_NEAR(ring.inner_radius, 20, 1e-12);
  EXPECT_NEAR(*ring.speed, 13 * std::numbers::pi / 30 * 0.066 / std::sqrt(9.81 * 3.3e-3), 1e-12);
}

FlowScene scene_of(const FlowGeometry& geometry) {
  FlowScene scene;
  scene.geometry = geometry;
  scene.grains = {.count = {}, .diameter_min_mm = 3, .diameter_max_mm = 3.6, .density_kg_m3 = 2700};
  return scene;
}

RheologyFit paper_law() {
  RheologyFit law;
  law.mu = LogLaw{.a = 0.35, .b = 0.013};
  law.nu = nu;
  return law;
}

TEST(GapProblem, HoldsAllThatTheSceneAndTheLawName) {
  RheologyFit law = paper_law();
  law.k = NormalStressRatio{.I = {1e-3, 1e-2, 1e-1}, .k = {0.95, 1, 1.1}};
  for (const FlowGeometry& geometry :
       {FlowGeometry(FlowIncline{66, 18}), FlowGeometry(FlowPlaneShear{66, 72, 350}),
        FlowGeometry(FlowChute{33, 2000}), FlowGeometry(FlowAnnulus{66, 132, 13, 350})}) {
    FlowScene scene = scene_of(geometry);
    scene.effects.inertia = FlowInertia{};
    scene.effects.nonlocal = FlowNonlocal{.length = 1.5};
    const FlowProblem problem = gap_problem(scene, law);
    EXPECT_EQ(std::get<LogLaw>(problem.law).a, 0.35);
    EXPECT_EQ(problem.density, gap_of(scene, nu).weight);
    ASSERT_TRUE(problem.turned);
    EXPECT_DOUBLE_EQ(problem.turned->k.at_ln(std::log(1e-1)).value, 1.1);
    ASSERT_TRUE(problem.nonlocal);
    EXPECT_EQ(problem.nonlocal->length, 1.5);
    EXPECT_TRUE(problem.inertia);
  }
}

TEST(GapProblem, RefusesEffectsOfTheDrum) {
  FlowScene scene = scene_of(FlowIncline{66, 18});
  scene.effects.wall_slip = FlowWallSlip{.friction = 0.4};
  EXPECT_THROW(gap_problem(scene, paper_law()), InputError);
}

TEST(Gap, AxesOfAnAnnulusTurnWithThePlace) {
  for (const double s : {0.0, 0.1, 0.6, 0.9}) {
    const GapPlace here = gap_place(annulus(0.5), 3, s);
    EXPECT_NEAR(std::hypot(here.point.x, here.point.z), 23, 1e-12);
    EXPECT_NEAR(here.upward.x * here.point.x + here.upward.z * here.point.z, -23, 1e-12);  // at the axis
    EXPECT_NEAR(here.along.x, here.upward.z, 1e-15);  // x and z as right-handed as those of a strip
    EXPECT_NEAR(here.along.z, -here.upward.x, 1e-15);
  }
  // The inner wall moves towards +x.
  const FlowProblem problem = gap_problem(annulus(0.5), laws[0], {.growth = 1}, {});
  const GapPlace wall = gap_place(annulus(0.5), 0, 0.3);
  const Vec2 v = std::get<PrescribedVelocity>(problem.boundary.at(Side::top)).velocity(wall.point);
  EXPECT_NEAR(v.x * wall.along.x + v.z * wall.along.z, 0.5, 1e-12);
}

TEST(Gap, MeshIsFineWhereItFlowsAndFillsTheDepth) {
  const auto layers_of = [](const Gap& gap) {
    const auto problem = gap_problem(gap, laws[0], {.surface_cell = 0.1, .surface_zone = 1}, {});
    const auto* box = std::get_if<BoxDomain>(&problem.domain);
    return box ? box->layers : std::get<AnnulusDomain>(problem.domain).layers;
  };
  for (const Gap& gap : {chute(27), plane_shear(0.4), annulus(0.5)}) {
    const auto layers = layers_of(gap);
    double sum = 0;
    for (const double layer : layers) sum += layer;
    EXPECT_NEAR(sum, gap.depth, 1e-9);
    const double at_flow = gap.flows_at_wall ? layers.back() : layers.front();
    EXPECT_LE(at_flow, 0.2 + 1e-12);  // on the coarser of two meshes
    EXPECT_EQ(at_flow, *std::min_element(layers.begin(), layers.end()));
  }
}

TEST(NoSteadyState, IsSaidOfAChuteWhoseWallsCannotCarryTheWeight) {
  // mu = nu W/P at the walls; the law gives 0.380 at I = 10.
  EXPECT_FALSE(no_steady_state(gap_problem(chute(27), laws[0], {}, {})));
  const auto reason = no_steady_state(gap_problem(chute(20), laws[0], {}, {}));
  ASSERT_TRUE(reason);
  expect_has(*reason, "0.4100");
  EXPECT_FALSE(no_steady_state(gap_problem(incline(18), laws[0], {}, {})));
  EXPECT_TRUE(no_steady_state(gap_problem(incline(23), laws[0], {}, {})));
  // Cohesion counts by its share of the pressure at the wall, 0.82 cos(60 deg) 20.
  const double missing = std::tan(60 * degree) - 0.3 - 10 * 0.1, weight = 0.82 * 0.5 * 20;
  EXPECT_TRUE(
      no_steady_state(gap_problem(incline(60), CohesiveLaw{0.99 * missing * weight, 0.3, 0.1}, {}, {})));
  EXPECT_FALSE(
      no_steady_state(gap_problem(incline(60), CohesiveLaw{1.01 * missing * weight, 0.3, 0.1}, {}, {})));
  EXPECT_FALSE(no_steady_state(gap_problem(plane_shear(100), laws[0], {}, {})));  // driven: any stress
}

}  // namespace
}  // namespace drumlin::gap
