#include "continuum/fem/detail/scalar_field.hpp"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/sparsity_tools.h>

namespace drumlin::continuum::fem {
namespace {

dealii::IndexSet relevant_to(const dealii::DoFHandler<2>& places) {
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(places, relevant);
  return relevant;
}

}  // namespace

void give_pattern(const Discretisation& d, const dealii::DoFHandler<2>& places, SystemMatrix& matrix,
                  const std::function<void(dealii::DynamicSparsityPattern&)>& fill) {
  const dealii::IndexSet owned = places.locally_owned_dofs(), relevant = relevant_to(places);
  dealii::DynamicSparsityPattern pattern(owned.size(), owned.size(), relevant);
  fill(pattern);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, owned, d.mesh.get_communicator(), relevant);
  matrix.reinit(owned, owned, pattern, d.mesh.get_communicator());
}

ScalarField::ScalarField(const Discretisation& d, const dealii::FiniteElement<2>& kind)
    : element(kind.clone()), places(d.mesh) {
  places.distribute_dofs(*element);
  values.reinit(places.locally_owned_dofs(), relevant_to(places), d.mesh.get_communicator());
}

dealii::AffineConstraints<double> conforming_lines(const FlowProblem& problem, const ScalarField& field) {
  dealii::AffineConstraints<double> lines(relevant_to(field.places));
  dealii::DoFTools::make_hanging_node_constraints(field.places, lines);
  if (const auto* box = std::get_if<BoxDomain>(&problem.domain); box && box->periodic_x)
    dealii::DoFTools::make_periodicity_constraints(field.places, static_cast<int>(Side::left),
                                                   static_cast<int>(Side::right), 0, lines);
  lines.close();
  return lines;
}

void couple_in_cells(const Discretisation& d, const ScalarField& field,
                     const dealii::AffineConstraints<double>& lines, SystemMatrix& matrix) {
  give_pattern(d, field.places, matrix, [&](dealii::DynamicSparsityPattern& pattern) {
    dealii::DoFTools::make_sparsity_pattern(field.places, pattern, lines, /*keep_constrained_dofs=*/false);
  });
}

void couple_across_faces(const Discretisation& d, const ScalarField& field, SystemMatrix& matrix) {
  give_pattern(d, field.places, matrix, [&](dealii::DynamicSparsityPattern& pattern) {
    dealii::DoFTools::make_flux_sparsity_pattern(field.places, pattern);
  });
}

std::vector<double> values_at(const ScalarField& field, const MeshCell& cell,
                              const std::vector<dealii::Point<2>>& unit_points, unsigned int component) {
  std::vector<dealii::types::global_dof_index> indices(field.element->n_dofs_per_cell());
  on(field.places, cell)->get_dof_indices(indices);
  std::vector<double> values(unit_points.size());
  for (std::size_t q = 0; q < values.size(); ++q)
    for (unsigned int i = 0; i < indices.size(); ++i)
      values[q] +=
          field.values[indices[i]] * field.element->shape_value_component(i, unit_points[q], component);
  return values;
}

std::vector<double> at_quadrature(const ScalarField& field, const Discretisation& d, unsigned int component) {
  std::vector<double> all;
  all.reserve(d.mesh.n_locally_owned_active_cells() * d.quadrature.size());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const auto values = values_at(field, cell, d.quadrature.get_points(), component);
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

}  // namespace drumlin::continuum::fem
