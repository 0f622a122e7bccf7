// Drums that are stiff, fast, coarse, or impossible.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "continuum/fem/flow_solver.hpp"
#include "continuum/postprocessing/drum_profiles.hpp"
#include "coupling/core/basics/errors.hpp"
#include "tests/hardcases/continuum/case_lists.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace drumlin {
using namespace continuum;
namespace {

constexpr double degree = std::numbers::pi / 180;

double viscosity_contrast(const FlowField& field, const DrumGeometry& drum) {
  std::vector<Vec2> points;
  for (double x = -drum.radius; x < drum.radius; x += 0.23)
    for (double z = -0.01; z > drum.axis_offset - drum.radius; z -= 0.23) points.push_back({x, z});
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  for (const PointState& s : field.at(points))
    if (std::isfinite(s.viscosity)) {
      smallest = std::min(smallest, s.viscosity);
      largest = std::max(largest, s.viscosity);
    }
  return largest / smallest;
}

std::vector<HardCheck> contrast() {
  const DrumGeometry drum = small_drum();
  const FlowSolverOptions options = one_mesh();
  const FlowSolution flow = solve_flow(small_drum_problem(paper_law, 1e-8), options);
  double linear = flow.report.history.empty() ? std::nan("") : 0;
  for (const IterationReport& line : flow.report.history) linear = larger(linear, line.linear_residual);
  return {at_least("converged at eps = 1e-8", 1, flow.report.converged, ""),
          at_least("largest over smallest viscosity", 1e8, viscosity_contrast(flow.field, drum),
                   "mu p/eps in the core, mu p_min/(2 |D|) at the surface"),
          at_most("largest true residual of a linear solve", options.linear_tolerance, linear,
                  "||A x - b||/||b||, formed with the matrix"),
          at_most("residual", options.tolerance, flow.report.residual, ""),
          at_most("|Q/Q_expected - 1|", 1e-3, flux_error(flow.field, drum), "mass balance")};
}

std::vector<HardCheck> fast_drums() {
  std::vector<HardCheck> checks;
  double slower = 0;
  // The paper's drum at 15 rpm has Omega^2 R/g = 0.056; a drum centrifuges at 1. Without inertia a solution
  // exists for any speed: mu grows without bound.
  for (const double froude : {0.056, 0.25, 1.0}) {
    DrumGeometry drum = small_drum();
    drum.rotation = std::sqrt(froude / drum.radius);
    const FlowSolution flow = solve_flow(small_drum_problem(drum), one_mesh());
    const double theta = flow.field.theta() / degree;
    checks.push_back(
        at_least(fmt::format("Omega^2 R/g = {:g}: converged", froude), 1, flow.report.converged, ""));
    checks.push_back(
        at_least("  slope above that of the slower drum, deg", slower, theta, "mu grows with I"));
    checks.push_back(at_most("  |Q/Q_expected - 1|", 1e-3, flux_error(flow.field, drum), "mass balance"));
    slower = theta;
  }
  return checks;
}

std::vector<HardCheck> impossible_slope() {
  DrumGeometry drum = small_drum();
  drum.slope = 23 * degree;
  int iterations = 0;
  FlowObserver observer;
  observer.iteration = [&](const IterationReport&) { ++iterations; };
  bool refused = false, says_why = false;
  try {
    (void)solve_flow(small_drum_problem(drum), one_mesh(), observer);
  } catch (const NotConvergedError& error) {
    refused = true;
    says_why = std::string(error.what()).find("no local steady state") != std::string::npos;
  }
  return {
      at_least("ends as not converged (exit 3)", 1, refused, ""),
      at_least("with the reason: no local steady state", 1, says_why, "tan 23 deg = 0.424 > mu(10) = 0.380"),
      equals("iterations spent", 0, iterations, 0, "known before the first one")};
}

std::vector<HardCheck> coarse_mesh() {
  // The paper's drum at 6 rpm.
  const DrumGeometry drum{.radius = 68.2, .axis_offset = 3, .rotation = 0.0115, .nu = 0.82};
  const auto problem =
      drum_problem(drum, paper_law, {.surface_cell = 4, .surface_zone = 16, .levels = 1}, {}, {});
  const FlowSolution flow = solve_flow(problem, one_mesh());
  return {at_least("converged on cells of 4 d", 1, flow.report.converged, ""),
          at_most("|Q/Q_expected - 1|", 1e-3, flux_error(flow.field, drum), "mass balance"),
          at_most("|wall torque/weight torque - 1|", 1e-3,
                  std::abs(drum_checks(flow.field, drum).value("torque_relative_error")), "moment balance")};
}

std::vector<HardCheck> ten_turns() {
  const DrumGeometry drum = small_drum();
  FlowProblem problem = small_drum_problem();
  problem.inertia = Inertia{};
  const FlowSolution steady = solve_flow(problem, one_mesh());
  const double theta = steady.field.theta(), turn = 2 * std::numbers::pi / drum.rotation;
  double drift = 0, worst_flux = 0;
  int steps = 0;
  const FlowSolution flow =
      march_flow(steady.field, problem,
                 {.time_step = turn / 20, .steps = 200, .stepped = [&](double, const FlowField& field) {
                    drift = larger(drift, std::abs(field.theta() - theta) / degree);
                    ++steps;
                    worst_flux = larger(worst_flux, flux_error(field, drum));
                  }});
  return {
      at_least("200 steps of a twentieth of a turn converged", 1, flow.report.converged && steps == 200, ""),
      at_most("largest drift of the slope, deg", 1e-4, drift, "a steady flow stays"),
      at_most("largest |Q/Q_expected - 1|", 1e-3, worst_flux, "mass balance at every time")};
}

}  // namespace

std::vector<HardCase> drum_flow_cases() {
  return {{"flow-contrast", "viscosities that differ by 1e8: Newton and the true linear residuals converge",
           true, contrast},
          {"flow-fast-drum", "steep and fast drums: a slope is found at any speed, and it grows", true,
           fast_drums},
          {"flow-impossible-slope", "tan(theta) above the law's mu: said at once", true, impossible_slope},
          {"flow-ten-turns", "ten turns in time with inertia: a steady drum does not drift", true, ten_turns},
          {"flow-coarse-mesh", "6 rpm drum on cells of 4 d: balances hold on any mesh", false, coarse_mesh}};
}

}  // namespace drumlin
