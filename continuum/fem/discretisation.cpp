#include "continuum/fem/detail/discretisation.hpp"

#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>
#include <deal.II/distributed/grid_refinement.h>
#include <deal.II/distributed/solution_transfer.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/numerics/vector_tools_boundary.h>

#include <array>
#include <map>
#include <set>

#include "continuum/fem/detail/direct_solver.hpp"
#include "continuum/fem/detail/split_triangles.hpp"

namespace drumlin::continuum::fem {
namespace {

using BoundaryValues = std::map<dealii::types::global_dof_index, double>;

class VelocityFunction : public dealii::Function<2> {
 public:
  VelocityFunction(unsigned int components, const std::function<Vec2(Vec2)>& velocity)
      : Function(components), velocity_(velocity) {}
  void vector_value(const dealii::Point<2>& p, dealii::Vector<double>& value) const override {
    const Vec2 v = velocity_({p[0], p[1]});
    value = 0;
    value[0] = v.x;
    value[1] = v.z;
  }

 private:
  const std::function<Vec2(Vec2)>& velocity_;
};

// That of the condition, or where the ends of the surface have moved what the problem says of the bottom
// then.
std::function<Vec2(Vec2)> given_velocity(const FlowProblem& problem, const Discretisation& d, Side side,
                                         const PrescribedVelocity& given) {
  if (!d.surface || side != Side::bottom || !problem.moving_surface || !problem.moving_surface->wall_velocity)
    return given.velocity;
  return [&velocity = problem.moving_surface->wall_velocity, left = surface_point(*d.surface, -1),
          right = surface_point(*d.surface, 1)](Vec2 point) { return velocity(point, left, right); };
}

BoundaryValues prescribed_velocities(const FlowProblem& problem, const Discretisation& d) {
  BoundaryValues all;
  for (const auto& [side, condition] : problem.boundary)
    if (const auto* given = std::get_if<PrescribedVelocity>(&condition)) {
      BoundaryValues here;
      const auto velocity = given_velocity(problem, d, side, *given);
      dealii::VectorTools::interpolate_boundary_values(d.mapping, d.unknowns, static_cast<int>(side),
                                                       VelocityFunction(d.elements.n_components(), velocity),
                                                       here, d.velocity_mask());
      all.insert(here.begin(), here.end());
    }
  return all;
}

// The quadratic image of an arc lets a tangential velocity leak a little. Against the stiff surface that leak
// would stand as a mean pressure of stiffness times leak: take it out by the smallest change of the given
// velocities.
void remove_net_flux(const FlowProblem& problem, const Discretisation& d, BoundaryValues& values) {
  bool has_spring = false;
  for (const auto& [side, condition] : problem.boundary)
    has_spring |= std::holds_alternative<NormalSpring>(condition);
  if (!has_spring) return;

  FieldVector flux_of = d.field();
  dealii::FEFaceValues<2> face(
      d.mapping, d.elements, d.side_quadrature,
      dealii::update_values | dealii::update_normal_vectors | dealii::update_JxW_values);
  std::vector<dealii::types::global_dof_index> indices(d.elements.n_dofs_per_cell());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary()) continue;
      const auto* condition = condition_on(problem, cell->face(f)->boundary_id());
      if (!condition || !std::holds_alternative<PrescribedVelocity>(*condition)) continue;
      face.reinit(cell, f);
      cell->get_dof_indices(indices);
      for (unsigned int i = 0; i < indices.size(); ++i) {
        const unsigned int component = d.elements.system_to_component_index(i).first;
        if (!moves(component)) continue;
        for (const unsigned int q : face.quadrature_point_indices())
          flux_of[indices[i]] += face.shape_value(i, q) * face.normal_vector(q)[component] * face.JxW(q);
      }
    }
  }
  flux_of.compress(dealii::VectorOperation::add);
  flux_of.update_ghost_values();
  double flux = 0, weight = 0;
  for (const auto& [index, value] : values)
    if (value != 0 &&
        d.owned.is_element(index)) {  // a velocity that is nought by choice, at the corners, stays
      flux += flux_of[index] * value;
      weight += flux_of[index] * flux_of[index];
    }
  flux = d.sum(flux);
  weight = d.sum(weight);
  if (weight == 0) return;
  for (auto& [index, value] : values)
    if (value != 0) value -= flux / weight * flux_of[index];
}

// Some walls hold the material in one direction alone, a pressed wall along itself and one with friction
// along its normal: of the two velocities of each of their nodes, the one that lies nearer to that direction
// follows from the other. Where faces meet, the normal is their mean.
struct WallNode {
  std::array<dealii::types::global_dof_index, 2> index;
  dealii::Point<2> place;
  dealii::Tensor<1, 2> normal;
  bool along_wall = false;  // the direction that is held
  Vec2 velocity;
  bool is_corner = false;  // two walls meet at an angle: nothing moves against either
};

// Sine of the angle at which two sides of one wall meet at most; those of two walls meet at more.
constexpr double least_corner = 0.5;

std::vector<WallNode> wall_nodes(const FlowProblem& problem, const Discretisation& d) {
  std::map<dealii::types::global_dof_index, WallNode> nodes;  // by the first of the two
  const dealii::Quadrature<1> places(d.elements.get_unit_face_support_points());
  dealii::FEFaceValues<2> face(d.mapping, d.elements, places,
                               dealii::update_normal_vectors | dealii::update_quadrature_points);
  std::vector<dealii::types::global_dof_index> indices(d.elements.n_dofs_per_face());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (cell->is_artificial()) continue;
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary()) continue;
      const auto* condition = condition_on(problem, cell->face(f)->boundary_id());
      const auto* pressed = condition ? std::get_if<PressedWall>(condition) : nullptr;
      const auto* rough = condition ? std::get_if<FrictionWall>(condition) : nullptr;
      if (!pressed && !rough) continue;
      face.reinit(cell, f);
      cell->face(f)->get_dof_indices(indices);
      std::array<std::vector<unsigned int>, 4> of_component;  // in the order of the nodes of the face
      for (unsigned int i = 0; i < indices.size(); ++i)
        of_component[d.elements.face_system_to_component_index(i).first].push_back(i);
      for (std::size_t k = 0; k < of_component[0].size(); ++k) {
        const unsigned int i = of_component[0][k];
        WallNode& node = nodes[indices[i]];
        node.index = {indices[i], indices[of_component[1][k]]};
        node.place = face.quadrature_point(i);
        const auto normal = face.normal_vector(i);
        if (rough && std::abs(node.normal[0] * normal[1] - node.normal[1] * normal[0]) > least_corner)
          node.is_corner = true;
        node.normal += normal;
        node.along_wall = pressed != nullptr;
        const Vec2 place{node.place[0], node.place[1]};
        node.velocity = pressed ? pressed->velocity(place) : rough->velocity(place);
        if (problem.frame) {
          const Vec2 rigid = rigid_rotation(problem.frame->rotation, problem.frame->axis_offset, place);
          node.velocity = {node.velocity.x - rigid.x, node.velocity.z - rigid.z};
        }
      }
    }
  }
  std::vector<WallNode> list;
  for (const auto& entry : nodes) list.push_back(entry.second);
  return list;
}

void hold(const WallNode& node, bool with_velocity, dealii::AffineConstraints<double>& constraints) {
  if (node.is_corner) {
    for (const unsigned int c : {0u, 1u}) {
      if (constraints.is_constrained(node.index[c]) || !constraints.can_store_line(node.index[c])) continue;
      constraints.add_line(node.index[c]);
      if (with_velocity)
        constraints.set_inhomogeneity(node.index[c], c == 0 ? node.velocity.x : node.velocity.z);
    }
    return;
  }
  const dealii::Tensor<1, 2> held =
      node.along_wall ? dealii::Tensor<1, 2>{{-node.normal[1], node.normal[0]}} : node.normal;
  const int near = std::abs(held[0]) >= std::abs(held[1]) ? 0 : 1;
  const auto index = node.index[near];
  if (constraints.is_constrained(index) || !constraints.can_store_line(index)) return;
  constraints.add_line(index);
  if (held[1 - near] != 0) constraints.add_entry(index, node.index[1 - near], -held[1 - near] / held[near]);
  if (with_velocity)
    constraints.set_inhomogeneity(index,
                                  (node.velocity.x * held[0] + node.velocity.z * held[1]) / held[near]);
}

// Of a quadratic cell with straight sides and these vertices.
std::vector<dealii::Point<2>> support_points(const dealii::Triangulation<2>::cell_iterator& cell,
                                             const std::vector<Vec2>& vertices) {
  static const std::vector<dealii::Point<2>> units = dealii::FE_Q<2>(2).get_unit_support_points();
  std::vector<dealii::Point<2>> points(units.size());
  for (std::size_t k = 0; k < units.size(); ++k)
    for (unsigned int v = 0; v < 4; ++v) {
      const Vec2& x = vertices[cell->vertex_index(v)];
      points[k] += dealii::GeometryInfo<2>::d_linear_shape_function(units[k], v) * dealii::Point<2>(x.x, x.z);
    }
  return points;
}

}  // namespace

FieldVector frame_velocity(const FlowProblem& problem, const Discretisation& d) {
  const RotatingFrame& frame = problem.frame.value();
  return velocity_field(d, [&](Vec2 x) { return rigid_rotation(frame.rotation, frame.axis_offset, x); });
}

std::map<dealii::types::global_dof_index, dealii::Point<2>> places_of_unknowns(const Discretisation& d) {
#if DEAL_II_VERSION_GTE(9, 6, 0)
  return dealii::DoFTools::map_dofs_to_support_points(d.mapping, d.unknowns);
#else
  std::map<dealii::types::global_dof_index, dealii::Point<2>> places;
  dealii::DoFTools::map_dofs_to_support_points(d.mapping, d.unknowns, places);
  return places;
#endif
}

FieldVector velocity_field(const Discretisation& d, const std::function<Vec2(Vec2)>& velocity) {
  FieldVector result = d.field();
  const auto places = places_of_unknowns(d);
  const auto along_x = dealii::DoFTools::extract_dofs(
      d.unknowns, d.elements.component_mask(dealii::FEValuesExtractors::Scalar(0)));
  for (std::size_t k = 0; k < d.is_velocity.size(); ++k) {
    if (!d.is_velocity[k]) continue;
    const auto i = d.owned.nth_index_in_set(k);
    const Vec2 v = velocity({places.at(i)[0], places.at(i)[1]});
    result.local_element(k) = along_x.is_element(i) ? v.x : v.z;
  }
  result.update_ghost_values();
  return result;
}

Discretisation::Discretisation(const FlowProblem& problem)
    : mesh(MPI_COMM_WORLD, dealii::Triangulation<2>::limit_level_difference_at_vertices),
      elements(dealii::FE_Q<2>(2), 2, dealii::FE_Q<2>(1), problem.threshold_fluidity ? 2 : 1),
      unknowns(mesh) {
  make_mesh(problem.domain, mesh);
  distribute_unknowns(problem);
}

dealii::ComponentMask Discretisation::velocity_mask() const {
  return elements.component_mask(dealii::FEValuesExtractors::Vector(0));
}

double Discretisation::sum(double value) const {
  return dealii::Utilities::MPI::sum(value, mesh.get_communicator());
}

void Discretisation::refine(const FlowProblem& problem, FieldVector& solution) {
  mesh.set_all_refine_flags();
  execute_refinement(problem, solution);
}

void Discretisation::refine_adaptively(const FlowProblem& problem, FieldVector& solution, double share) {
  dealii::parallel::distributed::GridRefinement::refine_and_coarsen_fixed_number(
      mesh, velocity_error_indicator(*this, solution), share, 0);
  execute_refinement(problem, solution);
}

void Discretisation::execute_refinement(const FlowProblem& problem, FieldVector& solution) {
  dealii::parallel::distributed::SolutionTransfer<2, FieldVector> transfer(unknowns);
  mesh.prepare_coarsening_and_refinement();
  solution.update_ghost_values();
  transfer.prepare_for_coarsening_and_refinement(solution);
  mesh.execute_coarsening_and_refinement();
  undisturbed_.clear();
  distribute_unknowns(problem);
  solution = field();
  transfer.interpolate(solution);
  constraints.distribute(solution);
  solution.update_ghost_values();
}

void Discretisation::mark_given(const FlowProblem& problem) {
  std::set<dealii::types::boundary_id> sides;
  for (const auto& [side, condition] : problem.boundary)
    if (std::holds_alternative<PrescribedVelocity>(condition) ||
        std::holds_alternative<PressedWall>(condition) || std::holds_alternative<FrictionWall>(condition))
      sides.insert(static_cast<int>(side));
  given.clear();
  if (!sides.empty()) given = dealii::DoFTools::extract_boundary_dofs(unknowns, velocity_mask(), sides);
}

void Discretisation::place_cells() {
  const dealii::MappingQ<2> quadratic(2);
  if (!vertices.empty()) {
    mapping.initialize(mesh, [&](const dealii::Triangulation<2>::cell_iterator& cell) {
      return support_points(cell, vertices);
    });
    return;
  }
  if (!surface) {
    mapping.initialize(quadratic, mesh);
    return;
  }
  if (undisturbed_.empty()) {
    const std::vector<dealii::Point<2>> places = dealii::FE_Q<2>(2).get_unit_support_points();
    mapping.initialize(quadratic, mesh);
    for (const auto& cell : mesh.cell_iterators())
      for (const auto& unit : places)
        undisturbed_[cell->id()].push_back(mapping.transform_unit_to_real_cell(cell, unit));
  }
  mapping.initialize(mesh, [&](const dealii::Triangulation<2>::cell_iterator& cell) {
    std::vector<dealii::Point<2>> places = undisturbed_.at(cell->id());
    for (auto& x : places) {
      const Vec2 to = displaced(*surface, {x[0], x[1]});
      x = {to.x, to.z};
    }
    return places;
  });
}

bool Discretisation::measure_cells() {
  dealii::FEValues<2> fe(mapping, elements, quadrature,
                         dealii::update_inverse_jacobians | dealii::update_jacobians |
                             dealii::update_JxW_values | dealii::update_quadrature_points);
  points.clear();
  bool valid = true;
  for (const auto& cell : unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    for (const unsigned int q : fe.quadrature_point_indices()) {
      valid = valid && fe.jacobian(q).determinant() > 0;
      points.push_back({fe.quadrature_point(q), fe.inverse_jacobian(q), fe.JxW(q)});
    }
  }
  return sum(valid ? 0 : 1) == 0;
}

bool Discretisation::move_surface(const FlowProblem& problem, const SurfaceShape& shape) {
  surface = shape;
  place_cells();
  if (!measure_cells()) return false;
  constrain(problem);
  return true;
}

bool Discretisation::move_corners(const FlowProblem& problem, std::span<const Vec2> to) {
  vertices = SplitTriangles(*std::get<MeshedDomain>(problem.domain).mesh).places(to);
  place_cells();
  if (!measure_cells()) return false;
  constrain(problem);
  return true;
}

dealii::Tensor<1, 2> Discretisation::surface_normal(const dealii::Point<2>& point,
                                                    const dealii::Tensor<1, 2>& of_mesh) const {
  if (!surface) return of_mesh;
  const Vec2 n = continuum::surface_normal(*surface, across(*surface, {point[0], point[1]}));
  return dealii::Tensor<1, 2>({n.x, n.z});
}

void Discretisation::distribute_unknowns(const FlowProblem& problem) {
  place_cells();
  unknowns.distribute_dofs(elements);
  measure_cells();
  owned = unknowns.locally_owned_dofs();
  dealii::DoFTools::extract_locally_relevant_dofs(unknowns, relevant);
  const auto velocity = dealii::DoFTools::extract_dofs(unknowns, velocity_mask());
  is_velocity.assign(owned.n_elements(), false);
  for (const auto index : velocity) is_velocity[owned.index_within_set(index)] = true;
  forget_systems();
  constrain(problem);
}

void Discretisation::forget_systems() {
  for (auto& system : systems) system = std::make_shared<KeptSystem>();
}

void Discretisation::constrain(const FlowProblem& problem) {
  constraints.reinit(relevant);
  dealii::DoFTools::make_hanging_node_constraints(unknowns, constraints);
  if (const auto* box = std::get_if<BoxDomain>(&problem.domain); box && box->periodic_x)
    dealii::DoFTools::make_periodicity_constraints(unknowns, static_cast<int>(Side::left),
                                                   static_cast<int>(Side::right), 0, constraints);
  BoundaryValues values = prescribed_velocities(problem, *this);
  remove_net_flux(problem, *this, values);
  if (problem.frame) {
    const FieldVector rigid = frame_velocity(problem, *this);
    for (auto& [index, value] : values) value -= rigid[index];
  }
  homogeneous.reinit(relevant);
  homogeneous.merge(constraints);
  conforming.reinit(relevant);
  conforming.merge(constraints);
  conforming.close();
  for (const auto& [index, value] : values)
    if (!constraints.is_constrained(index)) {
      constraints.add_line(index);
      constraints.set_inhomogeneity(index, value);
      homogeneous.add_line(index);
    }
  const auto nodes = wall_nodes(problem, *this);
  for (const WallNode& node : nodes) {
    hold(node, true, constraints);
    hold(node, false, homogeneous);
  }
  // What follows from what at such a wall depends on where its nodes are.
  if (sum(static_cast<double>(nodes.size())) > 0) systems[0] = std::make_shared<KeptSystem>();
  mark_given(problem);
  constraints.close();
  homogeneous.close();
}

}  // namespace drumlin::continuum::fem
