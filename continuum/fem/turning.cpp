#include "continuum/fem/detail/turning.hpp"

#include <deal.II/base/quadrature.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>

#include <array>
#include <cmath>
#include <optional>

#include "continuum/rheology/spin.hpp"
#include "continuum/rheology/tensor_law.hpp"

namespace drumlin::continuum::fem {
namespace {

using dealii::FEValues;
using dealii::FEValuesExtractors::Vector;
using Cell = MeshCell;

// As the laboratory sees it: D is written in its axes, so that a turning observer's velocity would not do.
struct Velocity {
  std::vector<dealii::Tensor<1, 2>> value;
  std::vector<dealii::Tensor<2, 2>> gradient;

  Velocity(const FEValues<2>& fe, const FieldVector& solution, const std::optional<RotatingFrame>& frame)
      : value(fe.n_quadrature_points), gradient(fe.n_quadrature_points) {
    fe[Vector(0)].get_function_values(solution, value);
    fe[Vector(0)].get_function_gradients(solution, gradient);
    if (!frame) return;
    for (const unsigned int q : fe.quadrature_point_indices()) {
      const auto x = fe.quadrature_point(q);
      const Vec2 rigid = rigid_rotation(frame->rotation, frame->axis_offset, {x[0], x[1]});
      value[q][0] += rigid.x;
      value[q][1] += rigid.z;
      gradient[q][0][1] += frame->rotation;
      gradient[q][1][0] -= frame->rotation;
    }
  }
};

// A continuous field on a mesh whose nodes take the mean of what the cells around them say.
class NodalMean {
 public:
  NodalMean(const Discretisation& d, const dealii::DoFHandler<2>& places) : places_(places) {
    const dealii::IndexSet owned = places.locally_owned_dofs();
    dealii::IndexSet relevant;
    dealii::DoFTools::extract_locally_relevant_dofs(places, relevant);
    mean_.reinit(owned, relevant, d.mesh.get_communicator());
    count_.reinit(mean_);
    constraints_.reinit(relevant);
    dealii::DoFTools::make_hanging_node_constraints(places, constraints_);
    constraints_.close();
  }
  /// Values of one cell, in the order of its unknowns.
  void add(const Cell& cell, const std::vector<double>& values) {
    indices_.resize(values.size());
    on(places_, cell)->get_dof_indices(indices_);
    for (std::size_t i = 0; i < values.size(); ++i) {
      mean_[indices_[i]] += values[i];
      count_[indices_[i]] += 1;
    }
  }
  FieldVector take() {
    mean_.compress(dealii::VectorOperation::add);
    count_.compress(dealii::VectorOperation::add);
    for (std::size_t i = 0; i < mean_.locally_owned_size(); ++i)
      mean_.local_element(i) /= count_.local_element(i);
    mean_.update_ghost_values();
    constraints_.distribute(mean_);
    mean_.update_ghost_values();
    return std::move(mean_);
  }

 private:
  const dealii::DoFHandler<2>& places_;
  FieldVector mean_, count_;
  dealii::AffineConstraints<double> constraints_;
  std::vector<dealii::types::global_dof_index> indices_;
};

PlaneTensor strain_rate(const dealii::Tensor<2, 2>& g) {
  return {g[0][0], g[1][1], 0.5 * (g[0][1] + g[1][0])};
}

// The traceless part of D as a continuous field of the velocity's order: components (xx - zz)/2 and xz.
struct RecoveredRate {
  dealii::FESystem<2> element{dealii::FE_Q<2>(2), 2};
  dealii::DoFHandler<2> places;
  FieldVector rate;

  RecoveredRate(const Discretisation& d, const FieldVector& solution) : places(d.mesh) {
    places.distribute_dofs(element);
    NodalMean mean(d, places);
    FEValues<2> fe(d.mapping, d.elements,
                   dealii::Quadrature<2>(element.base_element(0).get_unit_support_points()),
                   dealii::update_values | dealii::update_gradients);
    std::vector<double> values(element.n_dofs_per_cell());
    for (const auto& cell : d.unknowns.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      fe.reinit(cell);
      const Velocity u(fe, solution, std::nullopt);  // a rotation adds nothing to D
      for (unsigned int i = 0; i < values.size(); ++i) {
        const auto [component, node] = element.system_to_component_index(i);
        const PlaneTensor D = strain_rate(u.gradient[node]);
        values[i] = component == 0 ? 0.5 * (D.xx - D.zz) : D.xz;
      }
      mean.add(cell, values);
    }
    rate = mean.take();
  }
};

double turn_here(const dealii::Tensor<1, 2>& u, const dealii::Tensor<2, 2>& g,
                 const std::vector<dealii::Tensor<1, 2>>& rate_gradient, const Regularisation& r,
                 double softness) {
  const PlaneTensor D = strain_rate(g);
  const double diagonal = u * rate_gradient[0], shear = u * rate_gradient[1];
  const double rate = regularised_rate(D, r);
  const double axes = eigenframe_spin(D, {diagonal, -diagonal, shear}, rate);
  return turn_of(0.5 * (g[0][1] - g[1][0]) - axes, rate, softness);
}

void fill_from_flow(Turning& turning, const FlowProblem& problem, const Discretisation& d,
                    const FieldVector& solution, const Regularisation& r) {
  const RecoveredRate recovered(d, solution);
  NodalMean mean(d, turning.places);
  const dealii::Quadrature<2> vertices(turning.element.get_unit_support_points());
  FEValues<2> fe(d.mapping, d.elements, vertices,
                 dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points);
  FEValues<2> fe_rate(d.mapping, recovered.element, vertices, dealii::update_gradients);
  std::vector<std::vector<dealii::Tensor<1, 2>>> gradients(vertices.size(),
                                                           std::vector<dealii::Tensor<1, 2>>(2));
  std::vector<double> values(vertices.size());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    fe_rate.reinit(on(recovered.places, cell));
    const Velocity u(fe, solution, problem.frame);
    fe_rate.get_function_gradients(recovered.rate, gradients);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = turn_here(u.value[i], u.gradient[i], gradients[i], r, problem.turned->softness);
    mean.add(cell, values);
  }
  turning.turn = mean.take();
}

}  // namespace

Turning::Turning(const Discretisation& d) : places(d.mesh) { places.distribute_dofs(element); }

std::vector<double> turn_at(const Turning& turning, const Discretisation& d, const Cell& cell,
                            const std::vector<dealii::Point<2>>& unit_points) {
  std::vector<double> values(unit_points.size());
  if (turning.given) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto x = d.mapping.transform_unit_to_real_cell(cell, unit_points[i]);
      values[i] = turning.given({x[0], x[1]});
    }
    return values;
  }
  std::vector<dealii::types::global_dof_index> indices(turning.element.n_dofs_per_cell());
  on(turning.places, cell)->get_dof_indices(indices);
  for (std::size_t i = 0; i < values.size(); ++i)
    for (unsigned int k = 0; k < indices.size(); ++k)
      values[i] += turning.turn[indices[k]] * turning.element.shape_value(k, unit_points[i]);
  return values;
}

std::shared_ptr<const Turning> turning_of(const FlowProblem& problem, const Discretisation& d,
                                          double regularisation_rate, const FieldVector& solution,
                                          const Turning* before, double share) {
  auto turning = std::make_shared<Turning>(d);
  turning->given = problem.turned->given_turn;
  if (!turning->given) {
    Regularisation r = problem.regularisation;
    r.shear_rate = regularisation_rate;
    fill_from_flow(*turning, problem, d, solution, r);
    if (before) {
      turning->turn.sadd(share, 1 - share, before->turn);
      turning->turn.update_ghost_values();
    }
  }
  turning->at_quadrature.reserve(d.mesh.n_locally_owned_active_cells() * d.quadrature.size());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const auto values = turn_at(*turning, d, cell, d.quadrature.get_points());
    turning->at_quadrature.insert(turning->at_quadrature.end(), values.begin(), values.end());
  }
  return turning;
}

}  // namespace drumlin::continuum::fem
