#include "continuum/fem/detail/region_fields.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>

#include <cmath>
#include <map>

#include "continuum/fem/flow_field.hpp"
#include "continuum/model/part_line.hpp"
#include "continuum/model/plane_vector.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum::fem {
namespace {

Vec2 nearest_on(const RegionMesh& mesh, Vec2 point) {
  Vec2 best;
  double least = INFINITY;
  for (const auto& edge : mesh.boundary) {
    const Vec2 at = nearest_point({mesh.vertices[edge.from], mesh.vertices[edge.to]}, point);
    const double distance = length(at - point);
    if (distance < least) least = distance, best = at;
  }
  return best;
}

// Outside of the old mesh the value of its nearest point.
std::vector<PointState> values_near(const FlowField& field, const RegionMesh& mesh,
                                    std::vector<Vec2> points) {
  std::vector<PointState> states = field.at(points);
  std::vector<Vec2> outside;
  std::vector<std::size_t> which;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (!std::isfinite(states[k].velocity.x)) {
      which.push_back(k);
      outside.push_back(nearest_on(mesh, points[k]));
    }
  const std::vector<PointState> there = field.at(outside);
  for (std::size_t i = 0; i < which.size(); ++i) {
    states[which[i]] = there[i];
    if (!std::isfinite(there[i].velocity.x))
      throw NotConvergedError("a new mesh lies far outside of the old one");
  }
  return states;
}

}  // namespace

// Q2's support points begin with the vertices, and an FESystem counts all components of one vertex after the
// other.
std::vector<Vec2> velocity_at_corners(const Discretisation& d, std::size_t corners, const FieldVector& u) {
  std::vector<double> sums(3 * corners, 0.0);
  std::vector<dealii::types::global_dof_index> indices(d.elements.n_dofs_per_cell());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    for (const unsigned int v : cell->vertex_indices()) {
      const unsigned int k = cell->vertex_index(v);
      if (k >= corners) continue;
      for (unsigned int c = 0; c < 2; ++c)
        sums[3 * k + c] += u[indices[d.elements.component_to_system_index(c, v)]];
      sums[3 * k + 2] += 1;
    }
  }
  dealii::Utilities::MPI::sum(sums, d.mesh.get_communicator(), sums);
  std::vector<Vec2> result(corners);
  for (std::size_t k = 0; k < corners; ++k)
    result[k] = {sums[3 * k] / sums[3 * k + 2], sums[3 * k + 1] / sums[3 * k + 2]};
  return result;
}

FieldVector field_of_corners(const Discretisation& d, const SplitTriangles& split,
                             const std::vector<Vec2>& corners) {
  const std::vector<Vec2> at = split.places(corners);
  FieldVector field = d.field();
  std::vector<dealii::types::global_dof_index> indices(d.elements.n_dofs_per_cell());
  const auto& nodes = d.elements.base_element(0).get_unit_support_points();
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    for (unsigned int a = 0; a < nodes.size(); ++a) {
      Vec2 value;
      for (unsigned int v = 0; v < 4; ++v) {
        const double share = dealii::GeometryInfo<2>::d_linear_shape_function(nodes[a], v);
        value.x += share * at[cell->vertex_index(v)].x;
        value.z += share * at[cell->vertex_index(v)].z;
      }
      for (unsigned int c = 0; c < 2; ++c)
        if (const auto i = indices[d.elements.component_to_system_index(c, a)]; d.owned.is_element(i))
          field[i] = c == 0 ? value.x : value.z;
    }
  }
  field.update_ghost_values();
  return field;
}

// Where cells have other slopes, the mean of theirs.
FieldVector displaced(const Discretisation& d, const FieldVector& u, const FieldVector& displacement) {
  FieldVector sums = d.field(), count = d.field();
  const dealii::Quadrature<2> nodes(d.elements.base_element(0).get_unit_support_points());
  dealii::FEValues<2> at(d.mapping, d.elements, nodes, dealii::update_gradients);
  std::vector<std::vector<dealii::Tensor<1, 2>>> slopes(
      nodes.size(), std::vector<dealii::Tensor<1, 2>>(d.elements.n_components()));
  std::vector<dealii::types::global_dof_index> indices(d.elements.n_dofs_per_cell());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    at.reinit(cell);
    at.get_function_gradients(u, slopes);
    cell->get_dof_indices(indices);
    for (unsigned int a = 0; a < nodes.size(); ++a) {
      dealii::Tensor<1, 2> step;
      for (unsigned int c = 0; c < 2; ++c)
        step[c] = displacement[indices[d.elements.component_to_system_index(c, a)]];
      for (unsigned int c = 0; c < (a < 4 ? 3 : 2); ++c) {
        const auto i = indices[d.elements.component_to_system_index(c, a)];
        sums(i) += slopes[a][c] * step;
        count(i) += 1;
      }
    }
  }
  sums.compress(dealii::VectorOperation::add);
  count.compress(dealii::VectorOperation::add);
  FieldVector result = u;
  for (std::size_t k = 0; k < sums.locally_owned_size(); ++k)
    if (count.local_element(k) > 0) result.local_element(k) += sums.local_element(k) / count.local_element(k);
  result.update_ghost_values();
  return result;
}

BoundaryFlow boundary_flow(const SolvedLevel& level, const SplitTriangles& split, std::size_t corners) {
  const Discretisation& d = *level.discretisation;
  const FieldVector& u = level.state.solution;
  BoundaryFlow flow{
      {velocity_at_corners(d, corners, u), std::vector<Vec2>(corners), std::vector<double>(corners, 0.0)}};
  std::vector<double> sums(3 * corners, 0.0);
  dealii::FEFaceValues<2> face(
      d.mapping, d.elements, d.side_quadrature,
      dealii::update_values | dealii::update_normal_vectors | dealii::update_JxW_values);
  std::vector<dealii::Tensor<1, 2>> velocity(d.side_quadrature.size());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    for (const unsigned int f : cell->face_indices()) {
      const auto side = cell->face(f);
      if (!side->at_boundary() || condition_on(level.problem, side->boundary_id())) continue;
      face.reinit(cell, f);
      face[dealii::FEValuesExtractors::Vector(0)].get_function_values(u, velocity);
      const bool is_free = side->boundary_id() == static_cast<int>(Side::top);
      // From the corner at one end to the middle of the triangle's side at the other.
      const bool corner_first = side->vertex_index(0) < corners;
      const unsigned int corner = side->vertex_index(corner_first ? 0 : 1);
      const auto& ends = split.parents[side->vertex_index(corner_first ? 1 : 0)];
      const unsigned int other = ends[1] == corner ? ends[2] : ends[1];
      for (const unsigned int q : face.quadrature_point_indices()) {
        const double flux = velocity[q] * face.normal_vector(q) * face.JxW(q);
        if (!is_free) {
          flow.outflow += flux;
          flow.outflow_energy += 0.5 * level.problem.density * velocity[q].norm_square() * flux;
          continue;
        }
        const double along = d.side_quadrature.point(q)[0], away = 0.5 * (corner_first ? along : 1 - along);
        for (const auto& [k, share] : {std::pair{corner, 1 - away}, std::pair{other, away}}) {
          sums[3 * k] += share * face.normal_vector(q)[0] * face.JxW(q);
          sums[3 * k + 1] += share * face.normal_vector(q)[1] * face.JxW(q);
          sums[3 * k + 2] += share * flux;
        }
      }
    }
  }
  dealii::Utilities::MPI::sum(sums, d.mesh.get_communicator(), sums);
  flow.outflow = d.sum(flow.outflow);
  flow.outflow_energy = d.sum(flow.outflow_energy);
  for (std::size_t k = 0; k < corners; ++k) {
    flow.motion.free_normal[k] = {sums[3 * k], sums[3 * k + 1]};
    flow.motion.free_flux[k] = sums[3 * k + 2];
  }
  return flow;
}

std::vector<Vec2> loads_on(const Region& region, double time, const SolvedLevel& level) {
  const Discretisation& d = *level.discretisation;
  const FieldVector forces = nodal_forces(level.problem, d, level.setting, level.state);
  const auto places = places_of_unknowns(d);
  const auto along_x = dealii::DoFTools::extract_dofs(
      d.unknowns, d.elements.component_mask(dealii::FEValuesExtractors::Scalar(0)));
  std::map<dealii::types::global_dof_index, std::pair<double, std::size_t>> part_of;
  for (std::size_t i = 0; i < region.parts.size(); ++i)
    for (const auto k : dealii::DoFTools::extract_boundary_dofs(
             d.unknowns, d.velocity_mask(), {static_cast<unsigned>(side_of_part(static_cast<int>(i)))})) {
      if (!d.owned.is_element(k)) continue;
      const auto& x = places.at(k);
      const PartLine line = line_of(region.parts[i], time);
      const Vec2 t = line.tangent(line.nearest({x[0], x[1]}));
      const std::pair<double, std::size_t> here{std::abs(along_x.is_element(k) ? t.x : t.z), i};
      const auto [at, is_new] = part_of.try_emplace(k, here);
      if (!is_new) at->second = std::min(at->second, here);
    }
  std::vector<double> sums(2 * region.parts.size(), 0.0);
  for (const auto& [k, part] : part_of) sums[2 * part.second + (along_x.is_element(k) ? 0 : 1)] -= forces[k];
  dealii::Utilities::MPI::sum(sums, d.mesh.get_communicator(), sums);
  std::vector<Vec2> result;
  for (std::size_t i = 0; i < sums.size(); i += 2) result.push_back({sums[i], sums[i + 1]});
  return result;
}

void transfer(const SolvedLevel& from, const RegionMesh& old_mesh, SolvedLevel& to) {
  const Discretisation& d = *to.discretisation;
  struct Node {
    dealii::types::global_dof_index x = 0, z = 0, p = dealii::numbers::invalid_dof_index;
  };
  std::vector<Vec2> points;
  std::vector<Node> nodes;
  std::vector<bool> seen(d.unknowns.n_dofs(), false);
  std::vector<dealii::types::global_dof_index> indices(d.elements.n_dofs_per_cell());
  const auto& units = d.elements.base_element(0).get_unit_support_points();
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (cell->is_artificial()) continue;
    cell->get_dof_indices(indices);
    for (unsigned int a = 0; a < units.size(); ++a) {
      Node node{indices[d.elements.component_to_system_index(0, a)],
                indices[d.elements.component_to_system_index(1, a)]};
      if (seen[node.x]) continue;
      seen[node.x] = true;
      if (a < 4) node.p = indices[d.elements.component_to_system_index(pressure_component, a)];
      const auto x = d.mapping.transform_unit_to_real_cell(cell, units[a]);
      points.push_back({x[0], x[1]});
      nodes.push_back(node);
    }
  }
  const auto states =
      values_near(FlowField(std::shared_ptr<const SolvedLevel>(&from, [](auto*) {})), old_mesh, points);
  FieldVector& solution = to.state.solution;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto set = [&](dealii::types::global_dof_index i, double value) {
      if (i != dealii::numbers::invalid_dof_index && d.owned.is_element(i)) solution[i] = value;
    };
    set(nodes[k].x, states[k].velocity.x);
    set(nodes[k].z, states[k].velocity.z);
    set(nodes[k].p, states[k].pressure);
  }
  solution.update_ghost_values();
}

}  // namespace drumlin::continuum::fem
