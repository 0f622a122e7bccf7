#pragma once
// Boxes with simple boundary data, and a solve that has to converge.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "continuum/fem/flow_solver.hpp"
#include "tests/continuum/orders.hpp"

namespace drumlin::testing_boxes {
using namespace continuum;

constexpr double degree = std::numbers::pi / 180;

inline PrescribedVelocity at_rest() {
  return {[](Vec2) { return Vec2{0, 0}; }};
}
inline Traction constant_traction(double x, double z) {
  return {[x, z](Vec2) { return Vec2{x, z}; }};
}

/// Periodic strip of height H on a wall at rest, a traction given at its top.
inline FlowProblem strip(double height, int cells, const StressLaw& law, const Traction& top) {
  FlowProblem problem;
  problem.domain = BoxDomain{
      .width = 2 * height / cells, .height = height, .cells_x = 2, .cells_z = cells, .periodic_x = true};
  problem.law = law;
  problem.slope = FixedSlope{0};
  problem.boundary[Side::bottom] = at_rest();
  problem.boundary[Side::top] = top;
  return problem;
}

inline FlowSolution ended(const FlowSolution& solution) {
  EXPECT_TRUE(solution.report.converged) << solution.report.failure;
  return solution;
}

inline FlowField converged(const FlowProblem& problem, const FlowSolverOptions& options,
                           const FlowObserver& observer = {}) {
  return ended(solve_flow(problem, options, observer)).field;
}

inline PointState state_at(const FlowField& field, Vec2 point) {
  return field.at(std::span(&point, 1)).front();
}

}  // namespace drumlin::testing_boxes
