#include "continuum/fem/detail/assembly.hpp"

#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>

#include <array>
#include <cmath>

#include "continuum/fem/detail/cell_shapes.hpp"
#include "continuum/fem/detail/fluidity_terms.hpp"
#include "continuum/fem/detail/friction_wall.hpp"
#include "continuum/fem/detail/inertia_terms.hpp"
#include "continuum/fem/detail/point_law.hpp"
#include "continuum/fem/detail/spring_faces.hpp"

namespace drumlin::continuum::fem {
namespace {

using dealii::FEValues;
using dealii::Vector;
using Indices = std::vector<dealii::types::global_dof_index>;

Vec2 body_force(const FlowProblem& problem, double theta, const dealii::Point<2>& x) {
  Vec2 f{problem.density * std::sin(theta), -problem.density * std::cos(theta)};
  if (problem.extra_force) {
    const Vec2 extra = problem.extra_force({x[0], x[1]});
    f.x += extra.x;
    f.z += extra.z;
  }
  return f;
}

void add_point_residual(const CellShapes& s, unsigned int q, const PointValues& at, const PlaneTensor& stress,
                        Vec2 force, double JxW, Vector<double>& residual) {
  for (unsigned int i = 0; i < s.n; ++i) {
    const auto k = q * s.n + i;
    if (s.component[i] == pressure_component)
      residual[i] -= s.value[k] * at.divergence * JxW;
    else if (moves(s.component[i]))
      residual[i] += (contraction(stress, s.rate[k]) - at.p * s.divergence[k] -
                      (s.component[i] == 0 ? force.x : force.z) * s.value[k]) *
                     JxW;
  }
}

template <class Response>
void add_point_tangent(const CellShapes& s, unsigned int q, const Response& response, double JxW,
                       dealii::FullMatrix<double>& matrix) {
  for (unsigned int j = 0; j < s.n; ++j) {
    const auto kj = q * s.n + j;
    if (s.component[j] == pressure_component) {
      const PlaneTensor by_p = response.by_pressure;
      for (unsigned int i = 0; i < s.n; ++i)
        if (moves(s.component[i])) {
          const auto ki = q * s.n + i;
          matrix(i, j) += s.value[kj] * (contraction(by_p, s.rate[ki]) - s.divergence[ki]) * JxW;
          matrix(j, i) -= s.value[kj] * s.divergence[ki] * JxW;
        }
    } else if (moves(s.component[j])) {
      const PlaneTensor d_stress = JxW * tangent(response, s.rate[kj]);
      for (unsigned int i = 0; i < s.n; ++i)
        if (moves(s.component[i])) matrix(i, j) += contraction(d_stress, s.rate[q * s.n + i]);
    }
  }
}

// The spring and the tractions on one side of a cell.
// The frame's own velocity at a point, which the unknown lacks.
Vec2 frame_velocity_at(const FlowProblem& problem, const dealii::Point<2>& x) {
  if (!problem.frame) return {};
  return rigid_rotation(problem.frame->rotation, problem.frame->axis_offset, {x[0], x[1]});
}

void add_friction_wall(const FrictionWall& wall, const FlowProblem& problem, const Regularisation& r,
                       const dealii::FEFaceValues<2>& face, unsigned int q, const CellShapes& s,
                       const Vector<double>& local, Vector<double>& residual,
                       dealii::FullMatrix<double>* matrix) {
  const auto x = face.quadrature_point(q);
  const std::array<double, 2> t = {-face.normal_vector(q)[1], face.normal_vector(q)[0]};
  const Vec2 frame = frame_velocity_at(problem, x), moving = wall.velocity({x[0], x[1]});
  double slip = (frame.x - moving.x) * t[0] + (frame.z - moving.z) * t[1], p = 0;
  for (unsigned int i = 0; i < s.n; ++i)
    if (const unsigned int c = s.component[i]; c == pressure_component)
      p += local[i] * face.shape_value(i, q);
    else if (moves(c))
      slip += local[i] * face.shape_value(i, q) * t[c];
  const WallFriction T = wall_friction(wall, r, slip, p);
  for (unsigned int i = 0; i < s.n; ++i) {
    if (!moves(s.component[i])) continue;
    const double at_i = face.shape_value(i, q) * t[s.component[i]] * face.JxW(q);
    residual[i] += T.traction * at_i;
    if (matrix)
      for (unsigned int j = 0; j < s.n; ++j) {
        const unsigned int cj = s.component[j];
        if (cj == fluidity_component) continue;
        (*matrix)(i, j) +=
            (cj == pressure_component ? T.by_pressure : T.by_slip * t[cj]) * face.shape_value(j, q) * at_i;
      }
  }
}

void add_side(const Discretisation& d, const BoundaryCondition& condition, const FlowProblem& problem,
              const Regularisation& regularisation, const dealii::FEFaceValues<2>& face, const CellShapes& s,
              const Vector<double>& local, Vector<double>& residual, dealii::FullMatrix<double>* matrix) {
  for (const unsigned int q : face.quadrature_point_indices()) {
    const auto normal = std::holds_alternative<NormalSpring>(condition)
                            ? d.surface_normal(face.quadrature_point(q), face.normal_vector(q))
                            : face.normal_vector(q);
    const double JxW = face.JxW(q);
    const auto along_normal = [&](unsigned int i) { return face.shape_value(i, q) * normal[s.component[i]]; };
    if (const auto* spring = std::get_if<NormalSpring>(&condition)) {
      const Vec2 frame = frame_velocity_at(problem, face.quadrature_point(q));
      double u_n = frame.x * normal[0] + frame.z * normal[1];
      for (unsigned int i = 0; i < s.n; ++i)
        if (moves(s.component[i])) u_n += local[i] * along_normal(i);
      for (unsigned int i = 0; i < s.n; ++i) {
        if (!moves(s.component[i])) continue;
        residual[i] += spring->stiffness * u_n * along_normal(i) * JxW;
        if (matrix)
          for (unsigned int j = 0; j < s.n; ++j)
            if (moves(s.component[j]))
              (*matrix)(i, j) += spring->stiffness * along_normal(i) * along_normal(j) * JxW;
      }
    } else if (const auto* given = std::get_if<Traction>(&condition)) {
      const auto x = face.quadrature_point(q);
      const Vec2 t = given->traction({x[0], x[1]});
      for (unsigned int i = 0; i < s.n; ++i)
        if (moves(s.component[i]))
          residual[i] -= (s.component[i] == 0 ? t.x : t.z) * face.shape_value(i, q) * JxW;
    } else if (const auto* pressed = std::get_if<PressedWall>(&condition)) {
      for (unsigned int i = 0; i < s.n; ++i)
        if (moves(s.component[i])) residual[i] += pressed->pressure * along_normal(i) * JxW;
    } else if (const auto* wall = std::get_if<FrictionWall>(&condition)) {
      add_friction_wall(*wall, problem, regularisation, face, q, s, local, residual, matrix);
    }
  }
}

// Takes nu times the acceleration of the material off the force; the unknown's frame does not matter.
void add_inertia(const FlowProblem& problem, const InertiaSetting& inertia, const CellShapes& s,
                 unsigned int q, const dealii::Point<2>& x, double JxW, const Vector<double>& local,
                 const Vector<double>& before, Vec2& force, dealii::FullMatrix<double>* matrix) {
  PointMotion at = point_motion(s, q, local);
  const double per_time = inertia.time_step > 0 ? problem.density / inertia.time_step : 0;
  if (per_time > 0) {
    const PointMotion was = point_motion(s, q, before);
    force.x -= per_time * (at.u[0] - was.u[0]);
    force.z -= per_time * (at.u[1] - was.u[1]);
  }
  if (problem.frame) {
    const Vec2 frame = frame_velocity_at(problem, x);
    at.u[0] += frame.x;
    at.u[1] += frame.z;
    at.gradient[0][1] += problem.frame->rotation;
    at.gradient[1][0] -= problem.frame->rotation;
  }
  const Vec2 convective = convective_acceleration(at);
  const double density = inertia.share * problem.density;
  force.x -= density * convective.x;
  force.z -= density * convective.z;
  if (matrix) add_inertia_tangent(s, q, at, density, per_time, JxW, *matrix);
}

template <class PointLaw>
void assemble(const FlowProblem& problem, const Discretisation& d, const PointLaw& law,
              const Setting& setting, const State& state,
              const dealii::AffineConstraints<double>& constraints, FieldVector& residual,
              dealii::PETScWrappers::MPI::SparseMatrix* matrix, bool forces_of_walls = false) {
  FEValues<2> fe(d.mapping, d.elements, d.quadrature,
                 dealii::update_values | dealii::update_gradients | dealii::update_JxW_values |
                     dealii::update_quadrature_points);
  dealii::FEFaceValues<2> face(d.mapping, d.elements, d.side_quadrature,
                               dealii::update_values | dealii::update_JxW_values |
                                   dealii::update_normal_vectors | dealii::update_quadrature_points);
  CellShapes shapes(d);
  Indices indices(shapes.n);
  Vector<double> local(shapes.n), local_residual(shapes.n), local_before;
  if (setting.inertia && setting.inertia->before) local_before.reinit(shapes.n);
  dealii::FullMatrix<double> local_matrix(shapes.n, shapes.n);
  residual = 0;
  if (matrix) *matrix = 0;
  std::size_t point = 0;
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    shapes.reinit(fe);
    cell->get_dof_indices(indices);
    cell->get_dof_values(state.solution, local);
    if (local_before.size() > 0) cell->get_dof_values(*setting.inertia->before, local_before);
    local_residual = 0;
    local_matrix = 0;
    for (const unsigned int q : fe.quadrature_point_indices()) {
      const PointValues at = point_values(shapes, q, local);
      const auto response = law(setting.regularisation, at, state.dual[point], point);
      ++point;
      Vec2 force = body_force(problem, state.theta, fe.quadrature_point(q));
      if (setting.inertia)
        add_inertia(problem, *setting.inertia, shapes, q, fe.quadrature_point(q), fe.JxW(q), local,
                    local_before, force, matrix ? &local_matrix : nullptr);
      add_point_residual(shapes, q, at, response.stress, force, fe.JxW(q), local_residual);
      if (matrix) add_point_tangent(shapes, q, response, fe.JxW(q), local_matrix);
      if constexpr (requires { response.balance; }) {
        const double amplitude = problem.threshold_fluidity->amplitude;
        add_fluidity_residual(shapes, q, at, amplitude, response.balance, fe.JxW(q), local_residual);
        if (matrix) add_fluidity_tangent(shapes, q, at, amplitude, response, fe.JxW(q), local_matrix);
      }
    }
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary())
        if (const auto* condition = condition_on(problem, cell->face(f)->boundary_id());
            condition && !(forces_of_walls && std::holds_alternative<FrictionWall>(*condition))) {
          face.reinit(cell, f);
          add_side(d, *condition, problem, setting.regularisation, face, shapes, local, local_residual,
                   matrix ? &local_matrix : nullptr);
        }
    constraints.distribute_local_to_global(local_residual, indices, residual);
    if (matrix) constraints.distribute_local_to_global(local_matrix, indices, *matrix);
  }
  residual.compress(dealii::VectorOperation::add);
  if (matrix) matrix->compress(dealii::VectorOperation::add);
}

}  // namespace

void assemble_residual(const FlowProblem& problem, const Discretisation& d, const Setting& setting,
                       const State& state, System& system) {
  with_point_law(problem, setting.law, state.held_values(), [&](const auto& law) {
    assemble(problem, d, law, setting, state, d.homogeneous, system.residual, nullptr);
  });
}

void assemble_tangent(const FlowProblem& problem, const Discretisation& d, const Setting& setting,
                      const State& state, System& system) {
  if (system.matrix.m() == 0) system.matrix.reinit(d.owned, d.owned, d.pattern, d.mesh.get_communicator());
  with_point_law(problem, setting.law, state.held_values(), [&](const auto& law) {
    assemble(problem, d, law, setting, state, d.homogeneous, system.residual, &system.matrix);
  });
}

FieldVector nodal_forces(const FlowProblem& problem, const Discretisation& d, const Setting& setting,
                         const State& state) {
  FieldVector forces = d.field();
  with_point_law(problem, setting.law, state.held_values(), [&](const auto& law) {
    assemble(problem, d, law, setting, state, d.conforming, forces, nullptr, true);
  });
  return forces;
}

FieldVector load(const Discretisation& d, Vec2 force_density) {
  FieldVector result = d.field();
  FEValues<2> fe(d.mapping, d.elements, d.quadrature, dealii::update_values | dealii::update_JxW_values);
  Indices indices(d.elements.n_dofs_per_cell());
  Vector<double> local(indices.size());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    cell->get_dof_indices(indices);
    local = 0;
    for (unsigned int i = 0; i < indices.size(); ++i) {
      const unsigned int component = d.elements.system_to_component_index(i).first;
      if (!moves(component)) continue;
      for (const unsigned int q : fe.quadrature_point_indices())
        local[i] += (component == 0 ? force_density.x : force_density.z) * fe.shape_value(i, q) * fe.JxW(q);
    }
    d.homogeneous.distribute_local_to_global(local, indices, result);
  }
  result.compress(dealii::VectorOperation::add);
  return result;
}

FieldVector surface_moment(const FlowProblem& problem, const Discretisation& d) {
  FieldVector result = d.field();
  const auto* chord = std::get_if<ChordDomain>(&problem.domain);
  const dealii::Point<2> axis(0, chord ? chord->axis_offset : 0);
  Indices indices(d.elements.n_dofs_per_cell());
  for_each_spring_face(problem, d, [&](const auto& cell, const auto& face, const NormalSpring& spring) {
    cell->get_dof_indices(indices);
    for (unsigned int i = 0; i < indices.size(); ++i) {
      const unsigned int component = d.elements.system_to_component_index(i).first;
      if (!moves(component)) continue;
      for (const unsigned int q : face.quadrature_point_indices()) {
        const auto normal = d.surface_normal(face.quadrature_point(q), face.normal_vector(q));
        result[indices[i]] += lever(face.quadrature_point(q), axis, normal) * spring.stiffness *
                              face.shape_value(i, q) * normal[component] * face.JxW(q);
      }
    }
  });
  result.compress(dealii::VectorOperation::add);
  return result;
}

std::vector<PlaneTensor> dual_of(const Discretisation& d, const Regularisation& r,
                                 const FieldVector& solution) {
  std::vector<PlaneTensor> dual;
  dual.reserve(d.mesh.n_locally_owned_active_cells() * d.quadrature.size());
  for_each_point(d, solution, [&](const PointValues& at, std::size_t) {
    dual.push_back((1 / regularised_rate(at.D, r)) * at.D);
  });
  return dual;
}

std::vector<PlaneTensor> advanced_dual(const Discretisation& d, const Regularisation& r, const State& state,
                                       const FieldVector& step) {
  std::vector<PlaneTensor> D, next;
  D.reserve(state.dual.size());
  next.reserve(state.dual.size());
  for_each_point(d, state.solution, [&](const PointValues& at, std::size_t) { D.push_back(at.D); });
  for_each_point(d, step, [&](const PointValues& change, std::size_t k) {
    next.push_back(continuum::advanced_dual(D[k], change.D, state.dual[k], regularised_rate(D[k], r)));
  });
  return next;
}

}  // namespace drumlin::continuum::fem
