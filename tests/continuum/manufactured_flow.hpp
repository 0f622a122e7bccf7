#pragma once
// A flow made up for the purpose, with the force that it needs, and how far a solution is from it.
#include <cmath>
#include <optional>
#include <vector>

#include "continuum/fem/flow_solver.hpp"
#include "continuum/rheology/spin.hpp"
#include "continuum/rheology/turned_law.hpp"

namespace drumlin::testing_manufactured {
using namespace continuum;

/// u = curl of sin(x) sin(2 z + 1.2), p smooth and positive; the force that they need under a law. The axes
/// of D turn from place to place, or one entry of the tangent's tensor alone would be seen; |D| > 0.6 in the
/// box, or D/|D| would turn within eps around a rigid point and the orders begin on cells smaller than that.
struct Manufactured {
  StressLaw law;
  Regularisation regularisation;
  std::optional<NonCoaxialStress> turned = {};  ///< with a given turn
  bool turn_from_flow = false;                  ///< the solver has to find that turn itself

  static Vec2 velocity(Vec2 p) {
    const double w = 2 * p.z + 1.2;
    return {2 * std::sin(p.x) * std::cos(w), -std::cos(p.x) * std::sin(w)};
  }
  static double dvx_dx(Vec2 p) { return 2 * std::cos(p.x) * std::cos(2 * p.z + 1.2); }
  static double dvx_dz(Vec2 p) { return -4 * std::sin(p.x) * std::sin(2 * p.z + 1.2); }
  static double dvz_dx(Vec2 p) { return std::sin(p.x) * std::sin(2 * p.z + 1.2); }
  static double pressure(Vec2 p) { return 3 + 0.5 * std::sin(1.3 * p.x + 0.2) * std::cos(0.9 * p.z) - p.z; }
  static PlaneTensor strain_rate(Vec2 p) { return {dvx_dx(p), -dvx_dx(p), 0.5 * (dvx_dz(p) + dvz_dx(p))}; }
  /// s sgn(W - Omega_D) of this flow, v.grad D by central differences.
  static double turn(Vec2 p, const Regularisation& regularisation, double softness) {
    const double h = 1e-5;
    const Vec2 u = velocity(p);
    const PlaneTensor D = strain_rate(p), ahead = strain_rate({p.x + h * u.x, p.z + h * u.z}),
                      behind = strain_rate({p.x - h * u.x, p.z - h * u.z});
    const PlaneTensor D_dot{(ahead.xx - behind.xx) / (2 * h), (ahead.zz - behind.zz) / (2 * h),
                            (ahead.xz - behind.xz) / (2 * h)};
    const double rate = regularised_rate(D, regularisation);
    return turn_of(0.5 * (dvx_dz(p) - dvz_dx(p)) - eigenframe_spin(D, D_dot, rate), rate, softness);
  }
  /// -p I + tau at a point.
  PlaneTensor stress(Vec2 p) const {
    const PlaneTensor D = strain_rate(p);
    const double pressure_here = pressure(p);
    const PlaneTensor tau =
        turned ? turned_response(std::get<LogLaw>(law), LocalRatio{&turned->k, turned->given_turn(p)},
                                 regularisation, D, pressure_here, D)
                     .stress
               : std::visit(
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

inline Errors errors(const FlowField& field) {
  std::vector<Vec2> points;
  constexpr int n = 60;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) points.push_back({(i + 0.5) / n - 0.5, -(j + 0.5) / n});
  const auto states = field.at(points);
  Errors sum;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec2 u = Manufactured::velocity(points[k]);
    sum.velocity += std::pow(states[k].velocity.x - u.x, 2) + std::pow(states[k].velocity.z - u.z, 2);
    sum.gradient += std::pow(states[k].dvx_dx - Manufactured::dvx_dx(points[k]), 2) +
                    std::pow(states[k].dvx_dz - Manufactured::dvx_dz(points[k]), 2);
    sum.pressure += std::pow(states[k].pressure - Manufactured::pressure(points[k]), 2);
  }
  return {std::sqrt(sum.velocity) / n, std::sqrt(sum.gradient) / n, std::sqrt(sum.pressure) / n};
}

/// A unit box of 4 by 4 cells, velocity given on three sides and the traction on the top. `made` has to
/// outlive it.
inline FlowProblem problem_of(const Manufactured& made) {
  FlowProblem problem;
  problem.domain = BoxDomain{.width = 1, .height = 1, .cells_x = 4, .cells_z = 4};
  problem.law = made.law;
  problem.turned = made.turned;
  if (problem.turned && made.turn_from_flow) problem.turned->given_turn = nullptr;
  problem.regularisation = made.regularisation;
  problem.slope = FixedSlope{0};
  problem.extra_force = [&made](Vec2 p) { return made.force(p); };
  for (const Side side : {Side::bottom, Side::left, Side::right})
    problem.boundary[side] = PrescribedVelocity{Manufactured::velocity};
  problem.boundary[Side::top] = Traction{[&made](Vec2 p) {
    const PlaneTensor s = made.stress(p);
    return Vec2{s.xz, s.zz};
  }};
  return problem;
}

/// I runs from 0.7 to 3 in this flow, k from 0.99 to 1.04: with 0.96 .. 1.1 (0.7 to 1.3 over the same I) the
/// law is ill-posed and Newton's method ends on the third mesh.
inline NonCoaxialStress some_k() { return {.k = StressRatioLaw({0.05, 20}, {0.9, 1.1})}; }

inline Manufactured of_friction_law() { return {LogLaw{0.35, 0.013}, {.shear_rate = 0.3, .pressure = 0.1}}; }

/// With k, and a turn that is told to the solver.
inline Manufactured of_given_turn() {
  Manufactured made = of_friction_law();
  made.turned = some_k();
  made.turned->given_turn = [](Vec2 p) { return 0.8 * std::cos(0.7 * p.x + 0.3 * p.z); };
  return made;
}

/// With k, and the turn that the flow itself has.
inline Manufactured of_found_turn() {
  Manufactured made = of_friction_law();
  made.turned = some_k();
  made.turned->softness = 1;  // keeps the turn smooth on these meshes
  made.turned->given_turn = [r = made.regularisation](Vec2 p) { return Manufactured::turn(p, r, 1); };
  made.turn_from_flow = true;
  return made;
}

}  // namespace drumlin::testing_manufactured
