#pragma once
// Boxes with simple boundary data, and a solve that has to converge.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "continuum/fem/flow_solver.hpp"

namespace drumlin::testing_boxes {

constexpr double degree = std::numbers::pi / 180;

inline continuum::PrescribedVelocity at_rest() {
  return {[](continuum::Vec2) { return continuum::Vec2{0, 0}; }};
}
inline continuum::Traction constant_traction(double x, double z) {
  return {[x, z](continuum::Vec2) { return continuum::Vec2{x, z}; }};
}

/// Periodic strip of height H on a wall at rest, a traction given at its top.
inline continuum::FlowProblem strip(double height, int cells, const continuum::StressLaw& law,
                                    const continuum::Traction& top) {
  continuum::FlowProblem problem;
  problem.domain = continuum::BoxDomain{
      .width = 2 * height / cells, .height = height, .cells_x = 2, .cells_z = cells, .periodic_x = true};
  problem.law = law;
  problem.slope = continuum::FixedSlope{0};
  problem.boundary[continuum::Side::bottom] = at_rest();
  problem.boundary[continuum::Side::top] = top;
  return problem;
}

inline continuum::FlowField converged(const continuum::FlowProblem& problem,
                                      const continuum::FlowSolverOptions& options,
                                      const continuum::FlowObserver& observer = {}) {
  continuum::FlowSolution solution = continuum::solve_flow(problem, options, observer);
  EXPECT_TRUE(solution.report.converged) << solution.report.failure;
  return solution.field;
}

inline continuum::PointState state_at(const continuum::FlowField& field, continuum::Vec2 point) {
  return field.at(std::span(&point, 1)).front();
}

}  // namespace drumlin::testing_boxes
