#include "continuum/fem/detail/assembly.hpp"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>

#include <array>
#include <cmath>

#include "continuum/fem/detail/cell_shapes.hpp"
#include "continuum/fem/detail/fluidity_terms.hpp"
#include "continuum/fem/detail/friction_wall.hpp"
#include "continuum/fem/detail/inertia_terms.hpp"
#include "continuum/fem/detail/point_law.hpp"
#include "continuum/fem/detail/scalar_field.hpp"
#include "continuum/fem/detail/spring_faces.hpp"

namespace drumlin::continuum::fem {
namespace {

using dealii::FEValues;
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
                        Vec2 force, double JxW, dealii::Vector<double>& residual) {
  const CellShapes::Point& shape = s.points[q];
  for (unsigned int a = 0; a < s.nodes; ++a) {
    residual[s.velocity[0][a]] +=
        ((stress.xx - at.p) * shape.x[a] + stress.xz * shape.z[a] - force.x * shape.value[a]) * JxW;
    residual[s.velocity[1][a]] +=
        (stress.xz * shape.x[a] + (stress.zz - at.p) * shape.z[a] - force.z * shape.value[a]) * JxW;
  }
  for (unsigned int b = 0; b < s.corners; ++b)
    residual[s.pressure[b]] -= shape.linear[b] * at.divergence * JxW;
}

// What velocities do to the forces goes to a place of its own, where loops over functions are loops over
// neighbours in memory.
template <class Response>
void add_point_tangent(const CellShapes& s, unsigned int q, const Response& response, double JxW,
                       VelocityTangent& by_velocity, dealii::FullMatrix<double>& matrix) {
  const CellShapes::Point& shape = s.points[q];
  for (unsigned int c = 0; c < 2; ++c)
    for (unsigned int b = 0; b < s.nodes; ++b) {
      const PlaneTensor stress = JxW * tangent(response, shape.rate(c, b));
      auto& [x, z] = by_velocity[c][b];
      for (unsigned int a = 0; a < s.nodes; ++a) {
        x[a] += stress.xx * shape.x[a] + stress.xz * shape.z[a];
        z[a] += stress.xz * shape.x[a] + stress.zz * shape.z[a];
      }
    }
  const PlaneTensor by_p = response.by_pressure;
  for (unsigned int b = 0; b < s.corners; ++b) {
    const unsigned int j = s.pressure[b];
    const double here = shape.linear[b] * JxW;
    for (unsigned int a = 0; a < s.nodes; ++a) {
      const unsigned int i_x = s.velocity[0][a], i_z = s.velocity[1][a];
      matrix(i_x, j) += here * ((by_p.xx - 1) * shape.x[a] + by_p.xz * shape.z[a]);
      matrix(i_z, j) += here * (by_p.xz * shape.x[a] + (by_p.zz - 1) * shape.z[a]);
      matrix(j, i_x) -= here * shape.x[a];
      matrix(j, i_z) -= here * shape.z[a];
    }
  }
}

// The frame's own velocity at a point, which the unknown lacks.
Vec2 frame_velocity_at(const FlowProblem& problem, const dealii::Point<2>& x) {
  if (!problem.frame) return {};
  return rigid_rotation(problem.frame->rotation, problem.frame->axis_offset, {x[0], x[1]});
}

void add_friction_wall(const FrictionWall& wall, const FlowProblem& problem, const Regularisation& r,
                       const dealii::FEFaceValues<2>& face, unsigned int q, const CellShapes& s,
                       const dealii::Vector<double>& local, dealii::Vector<double>& residual,
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

// The spring and the tractions on one side of a cell.
void add_side(const Discretisation& d, const BoundaryCondition& condition, const FlowProblem& problem,
              const Regularisation& regularisation, const dealii::FEFaceValues<2>& face, const CellShapes& s,
              const dealii::Vector<double>& local, dealii::Vector<double>& residual,
              dealii::FullMatrix<double>* matrix) {
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

// A free surface goes with the material in the mean over its sides alone. What would come in through it at a
// point has the velocity of the surface, as inflow of a convected field is given; `through`: what passes.
void add_inflow(double density, const dealii::FEFaceValues<2>& face, const CellShapes& s,
                const dealii::Vector<double>& local, const dealii::Vector<double>& mesh_velocity,
                const dealii::Vector<double>& through, dealii::Vector<double>& residual,
                dealii::FullMatrix<double>* matrix) {
  for (const unsigned int q : face.quadrature_point_indices()) {
    const auto normal = face.normal_vector(q);
    std::array<double, 2> relative{};
    double passing = 0;
    for (unsigned int i = 0; i < s.n; ++i) {
      const unsigned int c = s.component[i];
      if (!moves(c)) continue;
      relative[c] += (local[i] - mesh_velocity[i]) * face.shape_value(i, q);
      passing += through[i] * face.shape_value(i, q) * normal[c];
    }
    if (passing >= 0) continue;
    const double brought = density * passing * face.JxW(q);
    for (unsigned int i = 0; i < s.n; ++i) {
      const unsigned int c = s.component[i];
      if (!moves(c)) continue;
      const double at_i = brought * face.shape_value(i, q);
      residual[i] -= at_i * relative[c];
      if (!matrix) continue;
      for (unsigned int j = 0; j < s.n; ++j)
        if (s.component[j] == c) (*matrix)(i, j) -= at_i * face.shape_value(j, q);
    }
  }
}

// Takes nu times the acceleration of the material off the force; the unknown's frame does not matter.
void add_inertia(const FlowProblem& problem, const InertiaSetting& inertia, const CellShapes& s,
                 unsigned int q, const dealii::Point<2>& x, double JxW, PointMotion at,
                 const dealii::Vector<double>& before, const dealii::Vector<double>& mesh_velocity,
                 Vec2& force, VelocityTangent* tangent) {
  const double per_time = inertia.time_step > 0 ? problem.density / inertia.time_step : 0;
  if (per_time > 0) {
    const PointMotion was = point_motion(s, q, before);
    force.x -= per_time * (at.u[0] - was.u[0]);
    force.z -= per_time * (at.u[1] - was.u[1]);
  }
  if (mesh_velocity.size() > 0) {
    const PointMotion of_mesh = point_motion(s, q, mesh_velocity);
    for (unsigned int c = 0; c < 2; ++c) at.u[c] -= of_mesh.u[c];
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
  if (tangent) add_inertia_tangent(s, q, at, density, per_time, JxW, *tangent);
}

/// What one cell after the other adds to the residual and to the tangent, in its own numbering.
template <class PointLaw>
class CellSystem {
 public:
  CellSystem(const FlowProblem& problem, const Discretisation& d, const PointLaw& law, const Setting& setting,
             const State& state, bool with_tangent, bool forces_of_walls)
      : problem_(problem),
        d_(d),
        law_(law),
        setting_(setting),
        state_(state),
        with_tangent_(with_tangent),
        forces_of_walls_(forces_of_walls),
        face_(d.mapping, d.elements, d.side_quadrature,
              dealii::update_values | dealii::update_JxW_values | dealii::update_normal_vectors |
                  dealii::update_quadrature_points),
        shapes_(d),
        local_(shapes_.n) {
    if (setting.inertia && setting.inertia->before) before_.reinit(shapes_.n);
    if (setting.inertia && setting.inertia->mesh_velocity) mesh_velocity_.reinit(shapes_.n);
    if (setting.inertia && setting.inertia->passing) passing_.reinit(shapes_.n);
    contribution.indices.resize(shapes_.n);
    contribution.residual.reinit(shapes_.n);
    contribution.tangent.reinit(shapes_.n, shapes_.n);
  }

  /// Fills in the contribution of a cell of this rank, whose quadrature points are counted from `point` on.
  void reinit(const CellOfUnknowns& cell, std::size_t point) {
    points_ = &d_.points[point];
    shapes_.reinit(points_);
    cell->get_dof_indices(contribution.indices);
    cell->get_dof_values(state_.solution, local_);
    if (before_.size() > 0) cell->get_dof_values(*setting_.inertia->before, before_);
    if (mesh_velocity_.size() > 0) cell->get_dof_values(*setting_.inertia->mesh_velocity, mesh_velocity_);
    if (passing_.size() > 0) cell->get_dof_values(*setting_.inertia->passing, passing_);
    contribution.residual = 0;
    contribution.tangent = 0;
    if (with_tangent_) by_velocity_ = {};
    for (unsigned int q = 0; q < d_.quadrature.size(); ++q) add_point(q, point + q);
    if (with_tangent_) take_over_velocities();
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary()) add_face(cell, f);
  }

  CellContribution contribution;

 private:
  void take_over_velocities() {
    for (unsigned int c = 0; c < 2; ++c)
      for (unsigned int b = 0; b < shapes_.nodes; ++b)
        for (unsigned int of = 0; of < 2; ++of)
          for (unsigned int a = 0; a < shapes_.nodes; ++a)
            contribution.tangent(shapes_.velocity[of][a], shapes_.velocity[c][b]) +=
                by_velocity_[c][b][of][a];
  }

  void add_point(unsigned int q, std::size_t point) {
    VelocityTangent* by_velocity = with_tangent_ ? &by_velocity_ : nullptr;
    const dealii::Point<2>& place = points_[q].place;
    const double JxW = points_[q].JxW;
    const PointValues at = point_values(shapes_, q, local_);
    const auto response = law_(setting_.regularisation, at, state_.dual[point], point);
    Vec2 force = body_force(problem_, state_.theta, place);
    if (setting_.inertia)
      add_inertia(problem_, *setting_.inertia, shapes_, q, place, JxW, at.motion, before_, mesh_velocity_,
                  force, by_velocity);
    add_point_residual(shapes_, q, at, response.stress, force, JxW, contribution.residual);
    if (with_tangent_) add_point_tangent(shapes_, q, response, JxW, by_velocity_, contribution.tangent);
    if constexpr (requires { response.balance; }) {
      const double amplitude = problem_.threshold_fluidity->amplitude;
      add_fluidity_residual(shapes_, q, at, amplitude, response.balance, JxW, contribution.residual);
      if (with_tangent_) add_fluidity_tangent(shapes_, q, at, amplitude, response, JxW, contribution.tangent);
    }
  }

  void add_face(const CellOfUnknowns& cell, unsigned int f) {
    const auto* condition = condition_on(problem_, cell->face(f)->boundary_id());
    if (!condition && passing_.size() > 0 &&
        cell->face(f)->boundary_id() == static_cast<unsigned>(Side::top)) {
      face_.reinit(cell, f);
      add_inflow(problem_.density, face_, shapes_, local_, mesh_velocity_, passing_, contribution.residual,
                 with_tangent_ ? &contribution.tangent : nullptr);
    }
    if (!condition || (forces_of_walls_ && std::holds_alternative<FrictionWall>(*condition))) return;
    face_.reinit(cell, f);
    add_side(d_, *condition, problem_, setting_.regularisation, face_, shapes_, local_, contribution.residual,
             with_tangent_ ? &contribution.tangent : nullptr);
  }

  const FlowProblem& problem_;
  const Discretisation& d_;
  const PointLaw& law_;
  const Setting& setting_;
  const State& state_;
  bool with_tangent_;
  bool forces_of_walls_;
  const CellPoint* points_ = nullptr;  // of this cell
  dealii::FEFaceValues<2> face_;
  CellShapes shapes_;
  VelocityTangent by_velocity_;  // of this cell
  dealii::Vector<double> local_, before_, mesh_velocity_, passing_;
};

template <class PointLaw>
void assemble(const FlowProblem& problem, const Discretisation& d, const PointLaw& law,
              const Setting& setting, const State& state,
              const dealii::AffineConstraints<double>& constraints, FieldVector& residual, KeptSystem* kept,
              bool forces_of_walls = false) {
  CellSystem system(problem, d, law, setting, state, kept != nullptr, forces_of_walls);
  const CellContribution& of_cell = system.contribution;
  residual = 0;
  if (kept) kept->matrix = 0;
  std::size_t number = 0;
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    system.reinit(cell, number * d.quadrature.size());
    constraints.distribute_local_to_global(of_cell.residual, of_cell.indices, residual);
    if (kept) kept->add(number, of_cell.indices, of_cell.tangent, constraints);
    ++number;
  }
  residual.compress(dealii::VectorOperation::add);
  if (kept) kept->matrix.compress(dealii::VectorOperation::add);
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
  if (system.matrix.m() == 0)
    give_pattern(d, d.unknowns, system.matrix, [&](dealii::DynamicSparsityPattern& pattern) {
      dealii::DoFTools::make_sparsity_pattern(d.unknowns, pattern, d.homogeneous,
                                              /*keep_constrained_dofs=*/false);
    });
  with_point_law(problem, setting.law, state.held_values(), [&](const auto& law) {
    assemble(problem, d, law, setting, state, d.homogeneous, system.residual, system.kept.get());
  });
}

void assemble_cells(const FlowProblem& problem, const Discretisation& d, const Setting& setting,
                    const State& state, std::span<const OwnCell> cells, bool with_tangent,
                    const std::function<void(std::size_t, const CellContribution&)>& add) {
  with_point_law(problem, setting.law, state.held_values(), [&](const auto& law) {
    CellSystem system(problem, d, law, setting, state, with_tangent, false);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      system.reinit(cells[k].cell, cells[k].number * d.quadrature.size());
      add(k, system.contribution);
    }
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
  dealii::Vector<double> local(indices.size());
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
  std::vector<PlaneTensor> next = state.dual;
  dealii::Vector<double> local(d.elements.n_dofs_per_cell()), change(local.size());
  for_each_cell(d, [&](const CellShapes& shapes, const auto& cell, std::size_t first) {
    cell->get_dof_values(state.solution, local);
    cell->get_dof_values(step, change);
    advance_dual(shapes, r, local, change, &next[first]);
  });
  return next;
}

}  // namespace drumlin::continuum::fem
