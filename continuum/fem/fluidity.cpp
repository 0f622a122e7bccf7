#include "continuum/fem/detail/fluidity.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <fmt/format.h>

#include <cmath>

#include "continuum/fem/detail/direct_solver.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum::fem {
namespace {

struct HelmholtzSystem {
  SystemMatrix matrix;
  FieldVector mass, source;
};

void assemble(const Discretisation& d, const ScalarField& field,
              const dealii::AffineConstraints<double>& lines, double length,
              std::span<const double> local_fluidity, HelmholtzSystem& system) {
  couple_in_cells(d, field, lines, system.matrix);
  system.mass = field.values;
  system.mass = 0;
  system.source = system.mass;

  const dealii::QTrapezoid<2> vertices;
  dealii::FEValues<2> fe(d.mapping, *field.element, d.quadrature,
                         dealii::update_values | dealii::update_JxW_values);
  dealii::FEValues<2> fe_vertices(d.mapping, *field.element, vertices,
                                  dealii::update_gradients | dealii::update_JxW_values);
  const unsigned int n = fe.dofs_per_cell;
  std::vector<dealii::types::global_dof_index> indices(n);
  dealii::FullMatrix<double> stiffness(n, n);
  dealii::Vector<double> mass(n), source(n);
  std::size_t point = 0;
  for (const auto& cell : field.places.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    fe_vertices.reinit(cell);
    cell->get_dof_indices(indices);
    stiffness = 0, mass = 0, source = 0;
    for (const unsigned int q : fe.quadrature_point_indices()) {
      for (unsigned int i = 0; i < n; ++i) {
        mass[i] += fe.shape_value(i, q) * fe.JxW(q);
        source[i] += fe.shape_value(i, q) * local_fluidity[point] * fe.JxW(q);
      }
      ++point;
    }
    for (const unsigned int q : fe_vertices.quadrature_point_indices())
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          stiffness(i, j) += length * length * (fe_vertices.shape_grad(i, q) * fe_vertices.shape_grad(j, q)) *
                             fe_vertices.JxW(q);
    lines.distribute_local_to_global(stiffness, indices, system.matrix);
    lines.distribute_local_to_global(mass, indices, system.mass);
    lines.distribute_local_to_global(source, indices, system.source);
  }
  system.mass.compress(dealii::VectorOperation::add);
  system.source.compress(dealii::VectorOperation::add);
  for (const auto i : field.places.locally_owned_dofs())
    if (!lines.is_constrained(i)) system.matrix.add(i, i, system.mass[i]);
  system.matrix.compress(dealii::VectorOperation::add);
}

struct Spread {
  FieldVector g, mass, source;
  double linear_residual = 0;
};

Spread spread(const FlowProblem& problem, const Discretisation& d, const ScalarField& field, double length,
              std::span<const double> local_fluidity, double linear_tolerance) {
  const auto lines = conforming_lines(problem, field);
  Spread found;
  HelmholtzSystem system;
  assemble(d, field, lines, length, local_fluidity, system);
  DirectSolver factors;
  factors.factorise(system.matrix);
  found.g = system.source;
  found.linear_residual = factors.solve(system.source, found.g);
  found.mass = std::move(system.mass);
  found.source = std::move(system.source);
  if (!(found.linear_residual <= linear_tolerance))
    throw NotConvergedError(
        fmt::format("nonlocal fluidity: true relative residual {:.2e} of the linear solve, tolerance {:.1e}",
                    found.linear_residual, linear_tolerance));
  bool positive = true;
  for (const auto i : field.places.locally_owned_dofs())
    if (!lines.is_constrained(i)) positive = positive && found.g[i] > 0;
  if (d.sum(positive ? 0 : 1) > 0)
    throw NotConvergedError(
        "the nonlocal fluidity is not positive everywhere: its length requires a finer mesh");
  return found;
}

// The logarithm of `value` at each vertex that is free.
template <class Value>
std::shared_ptr<ScalarField> logarithm(const FlowProblem& problem, std::shared_ptr<ScalarField> field,
                                       const Value& value) {
  const auto lines = conforming_lines(problem, *field);
  for (const auto i : field->places.locally_owned_dofs())
    if (!lines.is_constrained(i)) field->values[i] = std::log(value(i));
  field->values.update_ghost_values();
  lines.distribute(field->values);
  field->values.update_ghost_values();
  return field;
}

}  // namespace

FluidityFactor fluidity_factor(const FlowProblem& problem, const Discretisation& d, double length,
                               std::span<const double> local_fluidity, double linear_tolerance) {
  auto field = std::make_shared<ScalarField>(d, dealii::FE_Q<2>(1));
  const Spread found = spread(problem, d, *field, length, local_fluidity, linear_tolerance);
  return {.ln_factor = logarithm(problem, std::move(field),
                                 [&](auto i) { return found.source[i] / (found.mass[i] * found.g[i]); }),
          .linear_residual = found.linear_residual};
}

std::shared_ptr<ScalarField> spread_fluidity(const FlowProblem& problem, const Discretisation& d,
                                             double length, std::span<const double> local_fluidity,
                                             double linear_tolerance) {
  auto field = std::make_shared<ScalarField>(d, dealii::FE_Q<2>(1));
  const Spread found = spread(problem, d, *field, length, local_fluidity, linear_tolerance);
  return logarithm(problem, std::move(field), [&](auto i) { return found.g[i]; });
}

}  // namespace drumlin::continuum::fem
