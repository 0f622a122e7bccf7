// Orders of convergence on a flow made up for the purpose.
#include <array>
#include <vector>

#include "boxes.hpp"

namespace drumlin {
namespace {

using namespace testing_boxes;

/// u = curl of sin(x) sin(z + 0.4), p smooth and positive; the force that they need under a law.
struct Manufactured {
  StressLaw law;
  Regularisation regularisation;

  static Vec2 velocity(Vec2 p) {
    return {std::sin(p.x) * std::cos(p.z + 0.4), -std::cos(p.x) * std::sin(p.z + 0.4)};
  }
  static double pressure(Vec2 p) { return 3 + 0.5 * std::sin(1.3 * p.x + 0.2) * std::cos(0.9 * p.z) - p.z; }
  /// -p I + tau at a point.
  PlaneTensor stress(Vec2 p) const {
    const double x = p.x, z = p.z + 0.4;
    const double diagonal = std::cos(x) * std::cos(z);
    const PlaneTensor D{diagonal, -diagonal, 0.5 * (-std::sin(x) * std::sin(z) + std::sin(x) * std::sin(z))};
    const double pressure_here = pressure(p);
    const PlaneTensor tau = std::visit(
        [&](const auto& chosen) {
          return stress_response(chosen, regularisation, D, pressure_here, D).stress;
        },
        law);
    return {tau.xx - pressure_here, tau.zz - pressure_here, tau.xz};
  }
  /// -div of the stress, by fourth-order differences: their error, 1e-11, is far below that of any mesh here.
  Vec2 force(Vec2 p) const {
    const double h = 1e-3;
    const auto slope = [&](Vec2 step, auto part) {
      const auto at = [&](double n) { return part(stress({p.x + n * step.x, p.z + n * step.z})); };
      return (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h);
    };
    const Vec2 along_x{h, 0}, along_z{0, h};
    const auto xx = [](const PlaneTensor& s) { return s.xx; };
    const auto zz = [](const PlaneTensor& s) { return s.zz; };
    const auto xz = [](const PlaneTensor& s) { return s.xz; };
    return {-slope(along_x, xx) - slope(along_z, xz), -slope(along_x, xz) - slope(along_z, zz)};
  }
};

struct Errors {
  double velocity = 0, gradient = 0, pressure = 0;
};

Errors errors(const FlowField& field) {
  std::vector<Vec2> points;
  constexpr int n = 60;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) points.push_back({(i + 0.5) / n - 0.5, -(j + 0.5) / n});
  const auto states = field.at(points);
  Errors sum;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec2 u = Manufactured::velocity(points[k]);
    const double x = points[k].x, z = points[k].z + 0.4;
    sum.velocity += std::pow(states[k].velocity.x - u.x, 2) + std::pow(states[k].velocity.z - u.z, 2);
    sum.gradient += std::pow(states[k].dvx_dx - std::cos(x) * std::cos(z), 2) +
                    std::pow(states[k].dvx_dz + std::sin(x) * std::sin(z), 2);
    sum.pressure += std::pow(states[k].pressure - Manufactured::pressure(points[k]), 2);
  }
  return {std::sqrt(sum.velocity) / n, std::sqrt(sum.gradient) / n, std::sqrt(sum.pressure) / n};
}

/// Errors on three meshes of a unit box, velocity given on three sides and the traction on the top.
std::array<Errors, 3> errors_on_three_meshes(const Manufactured& made) {
  FlowProblem problem;
  problem.domain = BoxDomain{.width = 1, .height = 1, .cells_x = 4, .cells_z = 4};
  problem.law = made.law;
  problem.regularisation = made.regularisation;
  problem.slope = FixedSlope{0};
  problem.surface_pressure = 3;
  problem.extra_force = [&](Vec2 p) { return made.force(p); };
  for (const Side side : {Side::bottom, Side::left, Side::right})
    problem.boundary[side] = PrescribedVelocity{Manufactured::velocity};
  problem.boundary[Side::top] = Traction{[&](Vec2 p) {
    const PlaneTensor s = made.stress(p);
    return Vec2{s.xz, s.zz};
  }};
  FlowSolverOptions options;
  options.levels = 3;
  options.tolerance = 1e-11;
  std::array<Errors, 3> found;
  FlowObserver observer;
  observer.level_finished = [&](int level, const FlowField& field) { found[level] = errors(field); };
  (void)converged(problem, options, observer);
  return found;
}

void expect_orders_of_Q2_Q1(const std::array<Errors, 3>& found) {
  // Halving the cells divides errors of order q by 2^q; a tenth of an order is left for the coarse meshes.
  for (int level = 1; level < 3; ++level) {
    EXPECT_GT(std::log2(found[level - 1].velocity / found[level].velocity), 2.9) << level;
    EXPECT_GT(std::log2(found[level - 1].gradient / found[level].gradient), 1.9) << level;
    EXPECT_GT(std::log2(found[level - 1].pressure / found[level].pressure), 1.9) << level;
  }
}

TEST(ManufacturedFlow, OfANewtonianFluidConvergesWithTheOrdersOfQ2Q1) {
  expect_orders_of_Q2_Q1(errors_on_three_meshes({NewtonianLaw{1}, {}}));
}

TEST(ManufacturedFlow, OfTheFrictionLawConvergesWithTheOrdersOfQ2Q1) {
  expect_orders_of_Q2_Q1(errors_on_three_meshes({LogLaw{0.35, 0.013}, {.shear_rate = 0.3, .pressure = 0.1}}));
}

}  // namespace
}  // namespace drumlin
