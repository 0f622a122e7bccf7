// Where the law leaves its range: no shear, no pressure.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "continuum/fem/flow_solver.hpp"
#include "continuum/postprocessing/gap_profiles.hpp"
#include "tests/hardcases/continuum/case_lists.hpp"

namespace drumlin {
using namespace continuum;
namespace {

const LogLaw paper{0.35, 0.013};
constexpr double nu = 0.82;

// Plane shear at the rate 1e-8 under the pressure 4, mu at the driven wall from the power that it puts in.
FlowSolution slowest_shear(double eps) {
  const Gap gap{.depth = 10, .nu = nu, .pressure = 4, .speed = 1e-7, .scalars = {"mu_wall"}};
  FlowSolverOptions options;
  options.levels = 1;
  options.tolerance = 1e-10;
  return solve_flow(gap_problem(gap, paper, {.surface_cell = 2.5, .surface_zone = 100, .levels = 1},
                                {.shear_rate = eps, .pressure = 1e-6}),
                    options);
}

double friction_in_the_middle(const FlowField& field) {
  const Vec2 middle{0.1, -5.1};
  const PointState s = field.at(std::span(&middle, 1)).front();
  return s.sigma_xz / s.sigma_zz;
}

std::vector<HardCheck> rate_to_zero() {
  const FlowSolution law = slowest_shear(1e-10), creeping = slowest_shear(1e-6);
  const double I = 1e-8 / 2;
  // Far below eps the law is a fluid of the viscosity that it has at |D| = eps/2.
  const double at_eps = paper.friction(1e-6 / 2).mu * 1e-8 / 1e-6;
  return {at_least("converged at eps = 1e-10", 1, law.report.converged, ""),
          equals("mu at a shear rate of 1e-8, eps = 1e-10", paper.a + paper.b * std::log(I),
                 friction_in_the_middle(law.field), 5e-5,
                 "the floor that keeps mu positive adds m^2/mu = 1e-5; eps takes mu (eps/rate)^2/2 = 5e-6"),
          at_least("converged at eps = 1e-6", 1, creeping.report.converged, ""),
          equals("mu there with eps = 1e-6: mu(eps) rate/eps", at_eps, friction_in_the_middle(creeping.field),
                 1e-6, "(rate/eps)^2/2 = 5e-5 of itself")};
}

std::vector<HardCheck> pressure_to_zero() {
  const double theta = 18 * std::numbers::pi / 180, cell = 0.25;
  const Gap gap{.depth = 10, .nu = nu, .weight = nu, .slope = theta, .scalars = {"surface_speed"}};
  FlowSolverOptions options;
  options.levels = 2;
  const FlowSolution flow =
      solve_flow(gap_problem(gap, paper, {.surface_cell = cell, .surface_zone = 100, .levels = 2},
                             {.shear_rate = 1e-6, .pressure = 1e-6}),
                 options);
  std::vector<Vec2> points;
  constexpr int n = 400;
  for (int i = 0; i < n; ++i) points.push_back({0.1 * cell, -10 * std::pow((i + 1e-6) / n, 3)});
  int not_a_number = 0;
  double mu_error = 0;
  const auto states = flow.field.at(points);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const PointState& s = states[i];
    const double sum =
        s.velocity.x + s.velocity.z + s.dvx_dz + s.sigma_xx + s.sigma_zz + s.sigma_xz + s.viscosity;
    not_a_number += !std::isfinite(sum);
    if (points[i].z < -1) mu_error = larger(mu_error, std::abs(s.sigma_xz / s.sigma_zz - std::tan(theta)));
  }
  const PointState& top = states.front();
  return {at_least("converged with p_min = 1e-6", 1, flow.report.converged, ""),
          equals("points that are not numbers, of 400", 0, not_a_number, 0, "towards the surface as i^3"),
          equals("sigma_zz at the surface", 0, top.sigma_zz, 1e-4,
                 "linear in depth, which the pressure's elements hold: the solver's tolerance is left"),
          equals("sigma_xz at the surface", 0, top.sigma_xz, 1e-6,
                 "mu p_min is the strength that is left at p = 0; mu < 1"),
          equals("|mu - tan 18 deg| below 1 d, largest", 0, mu_error, 5e-3,
                 "2 % of the shear rate are 3e-4 of mu; jumps between cells below the root")};
}

}  // namespace

std::vector<HardCase> limit_flow_cases() {
  return {{"flow-rate-to-zero", "plane shear at 1e-8: mu = a + b ln I as long as eps lies below the rate",
           true, rate_to_zero},
          {"flow-pressure-to-zero", "free surface of an incline: stresses vanish, mu = tan(theta) below",
           true, pressure_to_zero}};
}

}  // namespace drumlin
