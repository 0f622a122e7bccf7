#pragma once
// Residual and tangent of the discrete problem. Private to fem/.
#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <span>

#include "continuum/fem/detail/direct_solver.hpp"
#include "continuum/fem/detail/held_fields.hpp"

namespace drumlin::continuum::fem {

/// What Newton's method iterates on.
struct State {
  FieldVector solution;                    ///< velocity and pressure, with the copies around this rank's part
  double theta = 0;                        ///< rad
  std::vector<PlaneTensor> dual;           ///< D/|D| per quadrature point of this rank's cells
  std::shared_ptr<const HeldFields> held;  ///< null: the law takes D and p alone

  State() = default;
  // deal.II copies the unknowns that this rank owns, and leaves the rest of the copy at zero.
  State(const State& other)
      : solution(other.solution), theta(other.theta), dual(other.dual), held(other.held) {
    solution.update_ghost_values();
  }
  State(State&&) = default;
  State& operator=(const State&) = default;
  State& operator=(State&&) = default;
  ~State() = default;
  const HeldValues& held_values() const {
    static const HeldValues nothing;
    return held ? held->at_quadrature : nothing;
  }
};

/// After the share `alpha` of a step of solution and slope, with the dual as it was.
inline State moved(const State& state, const FieldVector& step, double theta_step, double alpha) {
  State next = state;
  next.solution.add(alpha, step);
  next.solution.update_ghost_values();
  next.theta += alpha * theta_step;
  return next;
}

/// How inertia enters one system.
struct InertiaSetting {
  double share = 1;      ///< of nu u.grad u
  double time_step = 0;  ///< 0: steady
  /// (u - before)/time_step is what u changes by along the nodes.
  std::shared_ptr<const FieldVector> before = nullptr;
  std::shared_ptr<const FieldVector> mesh_velocity = nullptr;  ///< null: the mesh stays where it is
  /// Of the material through a free surface, where its mesh moves: that of the velocities which it followed.
  std::shared_ptr<const FieldVector> passing = nullptr;
};

/// How one system is to be formed.
struct Setting {
  StressLaw law;
  Regularisation regularisation;
  std::optional<InertiaSetting> inertia;  ///< absent: no such term
};

/// A residual, and the matrix and the factors that are kept for the flow: those of the last tangent.
struct System {
  explicit System(const Discretisation& d) : residual(d.field()), kept(d.systems[0]) {}
  FieldVector residual;  ///< zero in constrained rows
  std::shared_ptr<KeptSystem> kept;
  SystemMatrix& matrix = kept->matrix;  ///< filled by assemble_tangent alone
};

void assemble_residual(const FlowProblem&, const Discretisation&, const Setting&, const State&, System&);
void assemble_tangent(const FlowProblem&, const Discretisation&, const Setting&, const State&, System&);

using CellOfUnknowns = dealii::DoFHandler<2>::active_cell_iterator;

/// A cell of this rank.
struct OwnCell {
  CellOfUnknowns cell;
  std::size_t number = 0;  ///< among the cells of this rank, in the order of the mesh
};
/// What it adds to the system, in its own numbering.
struct CellContribution {
  std::vector<dealii::types::global_dof_index> indices;
  dealii::Vector<double> residual;
  dealii::FullMatrix<double> tangent;
};
/// Calls add(k, contribution of cells[k]) for cells of this rank, one after the other; without tangents these
/// are zero. Concerns this rank alone.
void assemble_cells(const FlowProblem&, const Discretisation&, const Setting&, const State&,
                    std::span<const OwnCell> cells, bool with_tangent,
                    const std::function<void(std::size_t k, const CellContribution&)>& add);

/// The residual without the given velocities and without the friction of walls: its entries on a side that
/// moves as it is told are the forces of that side on the material.
FieldVector nodal_forces(const FlowProblem&, const Discretisation&, const Setting&, const State&);

/// Load of the force density (x, z), constrained rows zero.
FieldVector load(const Discretisation&, Vec2 force_density);
/// Lever of a pressure on a surface with this normal about an axis, in the sense of dv_x/dz: x on a chord.
inline double lever(const dealii::Point<2>& point, const dealii::Point<2>& axis,
                    const dealii::Tensor<1, 2>& normal) {
  return (point[0] - axis[0]) * normal[1] - (point[1] - axis[1]) * normal[0];
}
/// Linear functional whose product with the solution is the moment of sigma_nn = stiffness u_n about the
/// drum's axis: of a chord integral x sigma_nn dx.
FieldVector surface_moment(const FlowProblem&, const Discretisation&);

/// D/|D| of the solution at every quadrature point.
std::vector<PlaneTensor> dual_of(const Discretisation&, const Regularisation&, const FieldVector& solution);
/// The dual after the step `step` from `state`.
std::vector<PlaneTensor> advanced_dual(const Discretisation&, const Regularisation&, const State& state,
                                       const FieldVector& step);

}  // namespace drumlin::continuum::fem
