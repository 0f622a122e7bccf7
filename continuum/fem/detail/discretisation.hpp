#pragma once
// Mesh, Q2-Q1 elements, constraints: what assembly, solver and evaluation share. Private to fem/.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <memory>
#include <vector>

#include "continuum/model/flow_problem.hpp"

namespace drumlin::fem {

/// One mesh level of a problem. The triangulation is refined in place; everything else is rebuilt with it.
struct Discretisation {
  explicit Discretisation(const FlowProblem& problem);  ///< the coarsest mesh
  Discretisation(const Discretisation&) = delete;
  Discretisation& operator=(const Discretisation&) = delete;

  /// Halves every cell and carries `solution` over by interpolation.
  void refine(const FlowProblem& problem, dealii::Vector<double>& solution);

  dealii::Triangulation<2> mesh;
  dealii::MappingQ<2> mapping{2};
  dealii::FESystem<2> elements;
  dealii::DoFHandler<2> unknowns;
  dealii::QGauss<2> quadrature{3};
  dealii::QGauss<1> side_quadrature{4};
  dealii::AffineConstraints<double>
      constraints;  ///< of the solution: hanging nodes, periodicity, given velocities
  dealii::AffineConstraints<double> homogeneous;  ///< of a Newton step: the same lines without their values
  dealii::AffineConstraints<double> conforming;   ///< hanging nodes and periodicity alone
  dealii::SparsityPattern pattern;
  std::vector<bool> is_velocity;  ///< per unknown

 private:
  void distribute_unknowns(const FlowProblem& problem);
};

/// The coarsest mesh of a domain; boundary ids are the numbers of Side.
void make_mesh(const Domain& domain, dealii::Triangulation<2>& mesh);

inline const BoundaryCondition* condition_on(const FlowProblem& problem, dealii::types::boundary_id side) {
  const auto found = problem.boundary.find(static_cast<Side>(side));
  return found == problem.boundary.end() ? nullptr : &found->second;
}

}  // namespace drumlin::fem
