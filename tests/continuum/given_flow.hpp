#pragma once
// A velocity that is given, on the mesh of a problem that is not solved.
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>

#include <cmath>
#include <functional>
#include <map>

#include "continuum/fem/detail/scalar_field.hpp"
#include "tests/continuum/orders.hpp"

namespace drumlin::testing_given_flow {
using namespace continuum;

inline FlowProblem problem_on(const Domain& domain) {
  FlowProblem problem;
  problem.domain = domain;
  problem.slope = FixedSlope{0};
  return problem;
}

/// Uniformly refined.
struct GivenFlow {
  FlowProblem problem;
  fem::Discretisation d;
  fem::FieldVector solution;

  GivenFlow(const Domain& domain, int refinements, const std::function<Vec2(Vec2)>& velocity)
      : problem(problem_on(domain)), d(problem), solution(d.field()) {
    for (int i = 0; i < refinements; ++i) d.refine(problem, solution);
    fill(velocity);
  }
  void fill(const std::function<Vec2(Vec2)>& velocity) {
    solution = fem::velocity_field(d, velocity);
    solution.update_ghost_values();
  }
  /// `visit`(place, weight) at every quadrature point of this rank.
  void for_points(const std::function<void(Vec2, double)>& visit) const {
    dealii::FEValues<2> fe(d.mapping, d.elements, d.quadrature,
                           dealii::update_quadrature_points | dealii::update_JxW_values);
    for (const auto& cell : d.unknowns.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      fe.reinit(cell);
      for (const unsigned int q : fe.quadrature_point_indices())
        visit({fe.quadrature_point(q)[0], fe.quadrature_point(q)[1]}, fe.JxW(q));
    }
  }
  std::vector<double> at_points(const std::function<double(Vec2)>& function) const {
    std::vector<double> values;
    for_points([&](Vec2 x, double) { values.push_back(function(x)); });
    return values;
  }
  /// Root mean square of the difference of values per quadrature point from a function, where it is not NaN.
  double error(const std::vector<double>& values, const std::function<double(Vec2)>& exact) const {
    double sum = 0, area = 0;
    std::size_t point = 0;
    for_points([&](Vec2 x, double weight) {
      const double off = values[point++] - exact(x);
      if (std::isnan(off)) return;
      sum += off * off * weight;
      area += weight;
    });
    return std::sqrt(d.sum(sum) / d.sum(area));
  }
};

/// What `error` says of the flow on a mesh and on two of which each halves the cells of the last one.
template <class Error>
std::vector<double> errors_on_three_meshes(const Domain& domain, const std::function<Vec2(Vec2)>& velocity,
                                           Error error) {
  std::vector<double> errors;
  for (const int refinements : {0, 1, 2}) errors.push_back(error(GivenFlow(domain, refinements, velocity)));
  return errors;
}

inline const AnnulusDomain ring{.inner_radius = 2, .layers = {1, 1}, .cells_around = 16};

/// One flow in a ring as the laboratory sees it and as an observer does who turns about (0, 0.2).
struct TwoObservers {
  static constexpr double rotation = 0.5;
  GivenFlow laboratory{ring, 0, [](Vec2 x) {
                         const Vec2 rigid = rigid_rotation(rotation, 0.2, x);
                         return Vec2{rigid.x + 0.1 * x.z, rigid.z + 0.1 * x.x};
                       }};
  GivenFlow turning{ring, 0, [](Vec2 x) { return Vec2{0.1 * x.z, 0.1 * x.x}; }};

  TwoObservers() { turning.problem.frame = RotatingFrame{rotation, 0.2}; }
};

}  // namespace drumlin::testing_given_flow
