// Fluidity with a threshold: closed forms, a flow made up for the purpose, its tangent, and whole drums.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "boxes.hpp"
#include "continuum/fem/detail/point_law.hpp"
#include "continuum/fem/detail/settled_fluidity.hpp"
#include "continuum/fem/detail/solved_level.hpp"
#include "manufactured_flow.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace drumlin::threshold_fluidity {
using namespace continuum;
namespace {

using namespace testing_boxes;

FlowSolverOptions meshes(int levels) {
  FlowSolverOptions options;
  options.levels = levels;
  options.coarse_tolerance = options.tolerance;  // the errors of all meshes are compared
  return options;
}

using Misfit = std::function<double(Vec2, const PointState&)>;
struct Found {
  std::vector<std::vector<double>> errors;  // of each misfit, mesh by mesh: root mean square over the places
  FlowField field;
};
Found found_on_three_meshes(const FlowProblem& problem, const std::vector<Vec2>& places,
                            const std::vector<Misfit>& misfits) {
  std::vector<std::vector<double>> errors(misfits.size());
  FlowObserver observer;
  observer.level_finished = [&](int, const FlowField& field) {
    const auto states = field.at(places);
    for (std::size_t m = 0; m < misfits.size(); ++m) {
      double sum = 0;
      for (std::size_t i = 0; i < places.size(); ++i) sum += std::pow(misfits[m](places[i], states[i]), 2);
      errors[m].push_back(std::sqrt(sum / static_cast<double>(places.size())));
    }
  };
  FlowField field = converged(problem, meshes(3), observer);
  return {std::move(errors), std::move(field)};
}

std::vector<Vec2> down_to(double depth, double step) {
  std::vector<Vec2> places;
  for (double y = step / 2; y < depth; y += step) places.push_back({0.1, -y});
  return places;
}

TEST(ThresholdFluidity, DecaysFromAShearedLayerAtConstantMuBelowTheThreshold) {
  // mu = mu_s - A^2/l^2 (1 - 2/cosh^2(y/l)) at the depth y: a sheared layer at the top, below it mu_s -
  // A^2/l^2. There g is 1/cosh(y/l), which falls by e over l = A/sqrt(mu_s - mu) = 3.16.
  const double H = 30, P = 4, mu_s = 0.3, A = 1, below = 0.1, length = A / std::sqrt(below);
  const auto mu = [=](double z) {
    const double share = 1 / std::cosh(z / length);
    return mu_s - below * (1 - 2 * share * share);
  };
  FlowProblem problem = strip(H, 12, ConstantLaw{mu_s}, constant_traction(0, -P));
  problem.boundary[Side::top] = PressedWall{[](Vec2) { return Vec2{1, 0}; }, P};
  problem.regularisation = {.shear_rate = 1e-7, .pressure = 1e-4};
  problem.threshold_fluidity = ThresholdFluidity{A};
  problem.extra_force = [=](Vec2 x) {
    const double h = 1e-3;
    return Vec2{-P * (mu(x.z + h) - mu(x.z - h)) / (2 * h), 0};
  };
  // The speed of the plate says how much flows: 1 = mu_s l pi/2 g(0). The stress is found.
  const double top = 1 / (mu_s * length * std::numbers::pi / 2);
  const Found found = found_on_three_meshes(
      problem, down_to(4.5 * length, 0.3),
      {[&](Vec2 x, const PointState& s) { return std::log(s.fluidity / top * std::cosh(x.z / length)); }});
  expect_orders(found.errors[0], {1.7, 1.7});
  EXPECT_LT(found.errors[0][2], 5e-3);
  EXPECT_NEAR(state_at(found.field, {0, -20}).sigma_xz / P, mu(-20), 1e-3);
}

TEST(ThresholdFluidity, MakesADraggedLayerUnderItsWeightCreepExponentially) {
  // mu = tau/(nu s), s = y + P/nu, under a plate that P = nu A/sqrt(mu_s) presses on: g = s e^(-s/l), l =
  // A/sqrt(mu_s), has no flux at the plate and carries tau = 2 nu A sqrt(mu_s), whatever the speed; the shear
  // rate mu g is an exponential, and the speed with it.
  const double H = 24, nu = 0.8, mu_s = 0.25, A = 1, length = A / std::sqrt(mu_s), V = 0.5;
  FlowProblem problem = strip(H, 12, ConstantLaw{mu_s}, constant_traction(0, 0));
  problem.boundary[Side::top] = PressedWall{[=](Vec2) { return Vec2{V, 0}; }, nu * A / std::sqrt(mu_s)};
  problem.density = nu;
  problem.regularisation = {.shear_rate = 1e-7, .pressure = 1e-4};
  problem.threshold_fluidity = ThresholdFluidity{A};
  const double tau = 2 * nu * A * std::sqrt(mu_s);
  const Found found = found_on_three_meshes(
      problem, down_to(10, 0.3),
      {[&](Vec2 x, const PointState& s) { return std::log(s.velocity.x / (V * std::exp(x.z / length))); },
       [&](Vec2, const PointState& s) { return s.sigma_xz / tau - 1; }});
  for (const auto& errors : found.errors) expect_orders(errors, {1.7, 1.7});
  EXPECT_LT(found.errors[0][2], 2e-2);
  EXPECT_LT(found.errors[1][2], 1e-2);
}

// A ring whose fluidity is a wave between the cylinders, under a pressure that changes with the radius: the
// axes of D turn with the place, and the force that it needs comes from the law.
struct WavyRing {
  double inner = 2, outer = 4, A = 0.4;
  JopLaw law{0.3, 0.6, 0.3};

  double pressure(double r) const { return 3 + std::sin(r); }
  double g(double r) const { return 1 + 0.3 * std::cos(k() * (r - inner)); }
  double k() const { return std::numbers::pi / (outer - inner); }
  double lap_g(double r) const {
    const double phase = k() * (r - inner);
    return -0.3 * k() * (k() * std::cos(phase) + std::sin(phase) / r);
  }
  /// 2|D|, of which mu_loc g - 2|D| is A^2 lap g.
  double shear_rate(double r) const {
    double low = 0, high = 100;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      (law.friction(middle / std::sqrt(pressure(r))).mu * g(r) - middle > A * A * lap_g(r) ? low : high) =
          middle;
    }
    return low;
  }
  double stress(double r) const { return pressure(r) * shear_rate(r) / g(r); }
  /// d(v/r)/dr = -shear_rate/r, at rest outside; by Simpson's rule.
  double speed(double r) const {
    constexpr int n = 200;
    const double h = (outer - r) / n;
    double sum = 0;
    for (int i = 0; i <= n; ++i) {
      const double at = r + i * h;
      sum += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * shear_rate(at) / at;
    }
    return r * sum * h / 3;
  }
  static Vec2 turned(Vec2 x, double radial, double around) {
    const double r = std::hypot(x.x, x.z);
    return {(radial * x.x - around * x.z) / r, (radial * x.z + around * x.x) / r};
  }
  FlowProblem problem() const {
    FlowProblem ring;
    ring.domain = AnnulusDomain{.inner_radius = inner, .layers = {1, 1}, .cells_around = 16};
    ring.law = law;
    ring.slope = FixedSlope{0};
    ring.regularisation = {.shear_rate = 1e-8, .pressure = 1e-6};
    ring.threshold_fluidity = ThresholdFluidity{A};
    ring.boundary[Side::top] = PrescribedVelocity{[*this](Vec2 x) { return turned(x, 0, speed(inner)); }};
    ring.boundary[Side::bottom] = PressedWall{[](Vec2) { return Vec2{0, 0}; }, pressure(outer)};
    ring.extra_force = [*this](Vec2 x) {
      const double r = std::hypot(x.x, x.z), h = 1e-4;
      const auto torque = [&](double at) { return at * at * stress(at); };
      return turned(x, std::cos(r), (torque(r + h) - torque(r - h)) / (2 * h * r * r));
    };
    return ring;
  }
};

TEST(ThresholdFluidity, OfAMadeUpRingConvergesWithSecondOrder) {
  const WavyRing ring;
  std::vector<Vec2> places;
  for (double r = 2.1; r < 3.95; r += 0.1)
    for (double angle = 0; angle < 6; angle += 0.7)
      places.push_back({r * std::cos(angle), r * std::sin(angle)});
  const auto radius = [](Vec2 x) { return std::hypot(x.x, x.z); };
  const Found found = found_on_three_meshes(
      ring.problem(), places,
      {[&](Vec2 x, const PointState& s) { return std::log(s.fluidity / ring.g(radius(x))); },
       [&](Vec2 x, const PointState& s) {
         const Vec2 v = WavyRing::turned(x, 0, ring.speed(radius(x)));
         return std::hypot(s.velocity.x - v.x, s.velocity.z - v.z);
       },
       [&](Vec2 x, const PointState& s) { return s.pressure - ring.pressure(radius(x)); }});
  for (const auto& errors : found.errors) expect_orders(errors, {1.8, 1.8});
}

FlowProblem small_creeping_drum(double amplitude) {
  FlowProblem problem = small_drum_problem(paper_law);
  problem.threshold_fluidity = ThresholdFluidity{amplitude, 0.3};
  return problem;
}

TEST(ThresholdFluidity, WithoutAmplitudeIsTheLocalLaw) {
  const testing_manufactured::Manufactured made = testing_manufactured::of_friction_law();
  FlowProblem problem = testing_manufactured::problem_of(made);
  problem.threshold_fluidity = ThresholdFluidity{0};
  std::vector<double> velocity, gradient, pressure;
  FlowObserver observer;
  observer.level_finished = [&](int, const FlowField& field) {
    const testing_manufactured::Errors here = testing_manufactured::errors(field);
    velocity.push_back(here.velocity);
    gradient.push_back(here.gradient);
    pressure.push_back(here.pressure);
  };
  const FlowField local = converged(problem, meshes(3), observer);
  // The elements of the fluidity are linear, and so of second order is the stress.
  expect_orders(velocity, {1.8, 1.8});
  expect_orders(gradient, {1.8, 1.8});
  expect_orders(pressure, {1.8, 1.8});
  const auto off = [&](double amplitude) {
    problem.threshold_fluidity->amplitude = amplitude;
    const FlowField field = converged(problem, meshes(3));
    double sum = 0;
    for (double x = -0.4; x < 0.5; x += 0.2)
      for (double z = -0.9; z < 0; z += 0.2)
        sum += std::pow(state_at(field, {x, z}).velocity.x - state_at(local, {x, z}).velocity.x, 2);
    return std::sqrt(sum);
  };
  const double near = off(0.01), far = off(0.02);
  EXPECT_GT(near, 1e-6);
  // A^2 inside, A^1.5 in the layers beside the sides, which no flux passes.
  EXPECT_GT(std::log2(far / near), 1.4);
}

TEST(ThresholdFluidity, LetsTheBedCreepTheMoreTheFartherItsGrainsFeelEachOther) {
  const auto rate = [](double amplitude) {
    return state_at(converged(small_creeping_drum(amplitude), one_mesh()), {0, -9}).rate;
  };
  EXPECT_GT(rate(1), 1.5 * rate(0.5));
}

TEST(ThresholdFluidity, IsNoUnknownWhereNobodyNamesIt) {
  const fem::Discretisation plain(small_drum_problem()), creeping(small_creeping_drum(1));
  EXPECT_FALSE(plain.has_fluidity());
  EXPECT_EQ(plain.elements.n_dofs_per_cell(), static_cast<unsigned int>(FlowState::values_per_cell));
  EXPECT_EQ(creeping.elements.n_dofs_per_cell(), static_cast<unsigned int>(FlowState::values_per_cell) + 4);
  const auto pressures = std::count(plain.is_velocity.begin(), plain.is_velocity.end(), false);
  EXPECT_EQ(creeping.owned.n_elements(), plain.owned.n_elements() + pressures);  // one per vertex too
}

}  // namespace
}  // namespace drumlin::threshold_fluidity
