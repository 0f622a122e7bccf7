#pragma once
// Mesh, elements (Q2-Q1, and Q1 for a fluidity with a threshold), constraints: what assembly, solver and
// evaluation share. Private to fem/.
#include <deal.II/base/derivative_form.h>
#include <deal.II/base/index_set.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "continuum/model/surface_shape.hpp"

namespace drumlin::continuum::fem {

/// One number per unknown, each on the rank that owns it; copies of those on the cells around that rank's
/// part follow with update_ghost_values().
using FieldVector = dealii::LinearAlgebra::distributed::Vector<double>;

struct KeptSystem;

/// Components of the unknowns after the two of the velocity; the last one only with a threshold of fluidity.
constexpr unsigned int pressure_component = 2, fluidity_component = 3;
inline bool moves(unsigned int component) { return component < pressure_component; }

/// A quadrature point in a cell.
struct CellPoint {
  dealii::Point<2> place;
  dealii::DerivativeForm<1, 2, 2> inverse_jacobian;  ///< [in the reference cell][in the cell]
  double JxW = 0;
};

/// One mesh level of a problem, cut into parts among the ranks of MPI_COMM_WORLD by p4est. The triangulation
/// is refined in place; everything else is rebuilt with it. All member functions are collective.
struct Discretisation {
  explicit Discretisation(const FlowProblem& problem);  ///< the coarsest mesh
  Discretisation(const Discretisation&) = delete;
  Discretisation& operator=(const Discretisation&) = delete;

  /// Halves every cell and carries `solution` over by interpolation.
  void refine(const FlowProblem& problem, FieldVector& solution);
  /// The same for the `share` of the cells with the largest error indicator (Kelly's, of the velocity).
  void refine_adaptively(const FlowProblem& problem, FieldVector& solution, double share);
  /// Takes over other velocities on the same sides.
  void constrain(const FlowProblem& problem);
  /// Moves cells and given velocities to this shape of the surface; unknowns keep their numbers. False, where
  /// a cell would be turned inside out.
  [[nodiscard]] bool move_surface(const FlowProblem& problem, const SurfaceShape& shape);
  /// Moves the corners of a region's triangles there, and all with them. False, where a cell would be turned
  /// inside out.
  [[nodiscard]] bool move_corners(const FlowProblem& problem, std::span<const Vec2> corners);
  /// Begins `systems` anew, for the memory that they hold.
  void forget_systems();
  /// Of the side with the spring, at one of its points: that of the mesh, or of the shape where the surface
  /// has moved. Quadratic sides meet at small angles, and what moves along both of them stands still: held by
  /// a stiff spring, each joint would stop the flow.
  dealii::Tensor<1, 2> surface_normal(const dealii::Point<2>& point,
                                      const dealii::Tensor<1, 2>& of_mesh) const;
  /// All zero.
  FieldVector field() const { return {owned, relevant, mesh.get_communicator()}; }
  double sum(double value) const;  ///< over the ranks
  dealii::ComponentMask velocity_mask() const;
  /// Whether ln g is one of the unknowns: with a threshold of fluidity alone.
  bool has_fluidity() const { return elements.n_components() > 3; }

  dealii::parallel::distributed::Triangulation<2> mesh;
  dealii::MappingQCache<2> mapping{2};  ///< quadratic cells; their support points are found once per mesh
  dealii::FESystem<2> elements;
  dealii::DoFHandler<2> unknowns;
  dealii::QGauss<2> quadrature{3};
  dealii::QGauss<1> side_quadrature{4};
  dealii::AffineConstraints<double>
      constraints;  ///< of the solution: hanging nodes, periodicity, given velocities
  dealii::AffineConstraints<double> homogeneous;  ///< of a Newton step: the same lines without their values
  dealii::AffineConstraints<double> conforming;   ///< hanging nodes and periodicity alone
  dealii::IndexSet owned, relevant;  ///< unknowns of this rank; with those of the cells around its part
  std::vector<bool> is_velocity;     ///< per unknown of this rank
  std::vector<CellPoint> points;     ///< of this rank's cells, one after the other

  /// That of the flow, and those of one number and of two that the flow carries along. Shared with those that
  /// solve: what they begin ends with the same factors.
  std::array<std::shared_ptr<KeptSystem>, 3> systems;

  /// Velocities on sides that move as they are told, in both directions or along themselves.
  dealii::IndexSet given;

  std::optional<SurfaceShape> surface;  ///< absent: it has not moved
  std::vector<Vec2> vertices;           ///< of a region's quadrilaterals, once they have moved

 private:
  void distribute_unknowns(const FlowProblem& problem);
  void execute_refinement(const FlowProblem& problem, FieldVector& solution);
  void mark_given(const FlowProblem& problem);
  void place_cells();
  bool measure_cells();  ///< the `points`; whether no cell is turned inside out

  /// Support points of the mapping of this mesh, once its surface has moved.
  std::map<dealii::CellId, std::vector<dealii::Point<2>>> undisturbed_;
};

/// The coarsest mesh of a domain; boundary ids are the numbers of Side.
void make_mesh(const Domain& domain, dealii::parallel::distributed::Triangulation<2>& mesh);

/// Where the unknowns lie, by their numbers.
std::map<dealii::types::global_dof_index, dealii::Point<2>> places_of_unknowns(const Discretisation& d);

/// The rigid rotation of the problem's frame, which has to be there, as a field: Q2 holds it exactly.
FieldVector frame_velocity(const FlowProblem& problem, const Discretisation& d);
/// The field with this velocity at every node, and no pressure.
FieldVector velocity_field(const Discretisation& d, const std::function<Vec2(Vec2)>& velocity);

/// Where a point lies on this rank's part of the mesh.
struct PlaceOnMesh {
  std::size_t point = 0;  ///< index of the point
  dealii::Point<2> unit;  ///< in the reference cell
};
struct CellPlaces {
  dealii::DoFHandler<2>::active_cell_iterator cell;
  std::vector<PlaceOnMesh> places;
};
/// The points that lie in cells of this rank, cell by cell; each point at most once.
std::vector<CellPlaces> locate(const Discretisation& d, std::span<const Vec2> points);

/// Kelly's error indicator of the velocity per active cell of this rank (0 on others): jumps of its gradient
/// across faces.
dealii::Vector<float> velocity_error_indicator(const Discretisation&, const FieldVector& solution);

inline const BoundaryCondition* condition_on(const FlowProblem& problem, dealii::types::boundary_id side) {
  const auto found = problem.boundary.find(static_cast<Side>(side));
  return found == problem.boundary.end() ? nullptr : &found->second;
}

}  // namespace drumlin::continuum::fem
