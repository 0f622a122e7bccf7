#include "continuum/fem/detail/settled_fluidity.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparsity_tools.h>

#include <algorithm>
#include <cmath>

#include "continuum/fem/detail/point_law.hpp"
#include "coupling/common/errors.hpp"

namespace drumlin::continuum::fem {
namespace {

constexpr int max_steps = 40;
constexpr double least_share = 0.1;  // of g that a step leaves: g stays positive

}  // namespace

SettledFluidity::SettledFluidity(const FlowProblem& problem, const Discretisation& d)
    : problem_(problem), d_(d), residual_(d.field()), step_(d.field()) {
  for (unsigned int i = 0; i < d.elements.n_dofs_per_cell(); ++i)
    if (d.elements.system_to_component_index(i).first == fluidity_component) local_.push_back(i);
  const auto ours = dealii::DoFTools::extract_dofs(
      d.unknowns, d.elements.component_mask(dealii::FEValuesExtractors::Scalar(fluidity_component)));
  is_fluidity_.assign(d.owned.n_elements(), false);
  for (const auto index : ours) is_fluidity_[d.owned.index_within_set(index)] = true;
  pattern_.reinit(d.unknowns.n_dofs(), d.unknowns.n_dofs(), d.relevant);
  std::vector<dealii::types::global_dof_index> indices(d.elements.n_dofs_per_cell()), here(local_.size());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    for (std::size_t i = 0; i < local_.size(); ++i) here[i] = indices[local_[i]];
    d.homogeneous.add_entries_local_to_global(here, pattern_, false);
  }
  for (const auto i : d.owned) pattern_.add(i, i);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern_, d.owned, d.mesh.get_communicator(),
                                                     d.relevant);
  matrix_.reinit(d.owned, d.owned, pattern_, d.mesh.get_communicator());
}

std::vector<SettledFluidity::Source> SettledFluidity::sources(const Setting& setting,
                                                              const State& state) const {
  std::vector<Source> found;
  with_fluidity_law(problem_, setting.law, state.held_values(), [&](const auto& law) {
    for_each_point(d_, state.solution, [&](const PointValues& at, std::size_t) {
      found.push_back({point_balance(law.law, law.effect, setting.regularisation, at).local,
                       2 * regularised_rate(at.D, setting.regularisation)});
    });
  });
  return found;
}

// In the form of g: the step is the relative one of g. Its matrix is that of (A^2 grad g, grad (w/g)) +
// (mu_loc g, w/g), which sees mu_loc where that of y sees 2|D|/g: the one differs from the other by the
// residual.
void SettledFluidity::assemble(const std::vector<Source>& at_points, const FieldVector& solution) {
  const double A2 = std::pow(problem_.threshold_fluidity->amplitude, 2);
  const dealii::FE_Q<2> element(1);
  dealii::FEValues<2> fe(d_.mapping, element, d_.quadrature,
                         dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  const auto n = static_cast<unsigned int>(local_.size());
  std::vector<dealii::types::global_dof_index> indices(d_.elements.n_dofs_per_cell()), here(n);
  dealii::FullMatrix<double> matrix(n, n);
  dealii::Vector<double> all(indices.size()), residual(n);
  matrix_ = 0;
  residual_ = 0;
  std::size_t point = 0;
  for (const auto& cell : d_.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const dealii::Triangulation<2>::cell_iterator place(cell);
    fe.reinit(place);
    cell->get_dof_indices(indices);
    cell->get_dof_values(solution, all);
    for (unsigned int i = 0; i < n; ++i) here[i] = indices[local_[i]];
    matrix = 0, residual = 0;
    for (const unsigned int q : fe.quadrature_point_indices()) {
      const Source& source = at_points[point++];
      double y = 0;
      dealii::Tensor<1, 2> slope;
      for (unsigned int i = 0; i < n; ++i) {
        y += all[local_[i]] * fe.shape_value(i, q);
        slope += all[local_[i]] * fe.shape_grad(i, q);
      }
      for (unsigned int i = 0; i < n; ++i) {
        const double w = fe.shape_value(i, q);
        const auto against = A2 * (fe.shape_grad(i, q) - w * slope);
        residual[i] += (slope * against + (source.local - source.rate * std::exp(-y)) * w) * fe.JxW(q);
        for (unsigned int j = 0; j < n; ++j)
          matrix(i, j) += ((fe.shape_grad(j, q) + fe.shape_value(j, q) * slope) * against +
                           source.local * fe.shape_value(j, q) * w) *
                          fe.JxW(q);
      }
    }
    d_.homogeneous.distribute_local_to_global(matrix, here, matrix_);
    d_.homogeneous.distribute_local_to_global(residual, here, residual_);
  }
  residual_.compress(dealii::VectorOperation::add);
  for (std::size_t k = 0; k < is_fluidity_.size(); ++k)
    if (!is_fluidity_[k]) {
      const auto i = d_.owned.nth_index_in_set(k);
      matrix_.add(i, i, 1);
    }
  matrix_.compress(dealii::VectorOperation::add);
}

void SettledFluidity::limit(double largest, FieldVector& step) const {
  for (std::size_t i = 0; i < is_fluidity_.size(); ++i)
    if (is_fluidity_[i]) step.local_element(i) = std::clamp(step.local_element(i), -largest, largest);
  step.update_ghost_values();
}

bool SettledFluidity::settle(const Setting& setting, double tolerance, State& state) {
  const std::vector<Source> at_points = sources(setting, state);
  for (int k = 0; k < max_steps; ++k) {
    assemble(at_points, state.solution);
    residual_ *= -1;
    try {
      factors_.factorise(matrix_);
      if (!(factors_.solve(residual_, step_) <= 1e-6)) return false;
    } catch (const NotConvergedError&) {
      return false;
    }
    double largest = 0;
    for (std::size_t i = 0; i < is_fluidity_.size(); ++i) {
      if (!is_fluidity_[i]) continue;
      const double change = step_.local_element(i);
      largest = std::max(largest, std::isfinite(change) ? std::abs(change) : INFINITY);
      state.solution.local_element(i) += std::log(std::max(least_share, 1 + change));
    }
    d_.conforming.distribute(state.solution);
    state.solution.update_ghost_values();
    largest = dealii::Utilities::MPI::max(largest, d_.mesh.get_communicator());
    if (!std::isfinite(largest)) return false;
    if (largest <= tolerance) return true;
  }
  return false;
}

}  // namespace drumlin::continuum::fem
