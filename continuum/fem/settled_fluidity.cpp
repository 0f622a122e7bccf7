#include "continuum/fem/detail/settled_fluidity.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <cmath>

#include "continuum/fem/detail/fluidity.hpp"
#include "continuum/fem/detail/point_law.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum::fem {
namespace {

constexpr int max_steps = 15;     // from one start
constexpr double near = 0.3;      // a step as small as this is followed by one with the exact derivative
constexpr double hopeless = 1e6;  // a step as large as this leads nowhere
constexpr double fluidity_tolerance = 1e-6;
constexpr double least_share = 0.1;  // of g that a step leaves: g stays positive

}  // namespace

SettledFluidity::SettledFluidity(const FlowProblem& problem, const Discretisation& d)
    : problem_(problem),
      d_(d),
      y_(d, dealii::FE_Q<2>(1)),
      lines_(conforming_lines(problem, y_)),
      residual_(y_.values),
      change_(y_.values) {
  std::vector<unsigned int> local;  // of the unknowns of a cell: those of y, vertex by vertex
  for (unsigned int i = 0; i < d.elements.n_dofs_per_cell(); ++i)
    if (d.elements.system_to_component_index(i).first == fluidity_component) local.push_back(i);
  std::vector<Index> of_flow(d.elements.n_dofs_per_cell()), here(local.size());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(of_flow);
    on(y_.places, cell)->get_dof_indices(here);
    for (std::size_t i = 0; i < local.size(); ++i) places_.emplace_back(of_flow[local[i]], here[i]);
  }
  std::sort(places_.begin(), places_.end());
  places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
  couple_in_cells(d, y_, lines_, matrix_);
}

std::vector<SettledFluidity::Source> SettledFluidity::sources(const Setting& setting,
                                                              const State& state) const {
  std::vector<Source> found;
  with_fluidity_law(problem_, setting.law, state.held_values(), [&](const auto& law) {
    for_each_point(d_, state.solution, [&](const PointValues& at, std::size_t) {
      found.push_back({point_balance(law.law, law.effect, setting.regularisation, at).mu_loc,
                       2 * regularised_rate(at.D, setting.regularisation)});
    });
  });
  return found;
}

// The residual, and the derivative of it by y or, from afar, of g times it by ln g, over g: that is the step
// of the equation of g, which is linear, and mu_loc stands in it where the other has 2|D|/g.
void SettledFluidity::assemble(const std::vector<Source>& at_points, bool exact) {
  const double A2 = std::pow(problem_.threshold_fluidity->amplitude, 2);
  dealii::FEValues<2> fe(d_.mapping, *y_.element, d_.quadrature,
                         dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  const unsigned int n = fe.dofs_per_cell;
  std::vector<Index> indices(n);
  dealii::FullMatrix<double> matrix(n, n);
  dealii::Vector<double> y_here(n), residual(n);
  matrix_ = 0;
  residual_ = 0;
  std::size_t point = 0;
  for (const auto& cell : y_.places.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    cell->get_dof_indices(indices);
    cell->get_dof_values(y_.values, y_here);
    matrix = 0, residual = 0;
    for (const unsigned int q : fe.quadrature_point_indices()) {
      const Source& source = at_points[point++];
      double y = 0;
      dealii::Tensor<1, 2> slope;
      for (unsigned int i = 0; i < n; ++i) {
        y += y_here[i] * fe.shape_value(i, q);
        slope += y_here[i] * fe.shape_grad(i, q);
      }
      const double mu = source.rate * std::exp(-y);
      for (unsigned int i = 0; i < n; ++i) {
        const double w = fe.shape_value(i, q);
        const auto against = A2 * (fe.shape_grad(i, q) - w * slope);
        residual[i] -= (slope * against + (source.local - mu) * w) * fe.JxW(q);
        for (unsigned int j = 0; j < n; ++j) {
          const double v = fe.shape_value(j, q);
          const double spread = fe.shape_grad(j, q) * (exact ? against - A2 * w * slope : against);
          matrix(i, j) += (spread + (exact ? mu * w : slope * against + source.local * w) * v) * fe.JxW(q);
        }
      }
    }
    lines_.distribute_local_to_global(matrix, indices, matrix_);
    lines_.distribute_local_to_global(residual, indices, residual_);
  }
  residual_.compress(dealii::VectorOperation::add);
  matrix_.compress(dealii::VectorOperation::add);
}

bool SettledFluidity::step() {
  try {
    factors_.factorise(matrix_);
    return factors_.solve(residual_, change_) <= fluidity_tolerance;
  } catch (const NotConvergedError&) {
    return false;
  }
}

void SettledFluidity::limit(double largest, FieldVector& step) const {
  for (const auto& [in_flow, in_y] : places_)
    if (d_.owned.is_element(in_flow)) step[in_flow] = std::clamp(step[in_flow], -largest, largest);
  step.update_ghost_values();
}

// Over one length everywhere, with the mass gathered at the vertices: positive, and no part of the answer.
bool SettledFluidity::start_anew(const std::vector<Source>& at_points) {
  std::vector<double> local;
  double mu = 0;
  for (const Source& source : at_points) {
    local.push_back(source.rate / source.local);
    mu += source.local;
  }
  mu = d_.sum(mu) / d_.sum(static_cast<double>(at_points.size()));
  try {
    y_.values = spread_fluidity(problem_, d_, problem_.threshold_fluidity->amplitude / std::sqrt(mu), local,
                                fluidity_tolerance)
                    ->values;
  } catch (const NotConvergedError&) {
    return false;
  }
  y_.values.update_ghost_values();
  return true;
}

bool SettledFluidity::iterate(const std::vector<Source>& at_points, double tolerance) {
  double largest = INFINITY;
  for (int k = 0; k < max_steps && largest > tolerance; ++k) {
    assemble(at_points, largest < near);
    if (!step()) return false;
    largest = 0;
    for (std::size_t i = 0; i < y_.values.locally_owned_size(); ++i) {
      const double change = change_.local_element(i);
      largest = std::max(largest, std::isfinite(change) ? std::abs(change) : INFINITY);
      y_.values.local_element(i) += std::log(std::max(least_share, 1 + change));
    }
    lines_.distribute(y_.values);
    y_.values.update_ghost_values();
    largest = dealii::Utilities::MPI::max(largest, d_.mesh.get_communicator());
    if (!(largest < hopeless)) return false;
  }
  return largest <= tolerance;
}

bool SettledFluidity::settle(const Setting& setting, double tolerance, State& state) {
  const std::vector<Source> at_points = sources(setting, state);
  const dealii::IndexSet& ours = y_.places.locally_owned_dofs();
  for (const auto& [in_flow, in_y] : places_)
    if (ours.is_element(in_y)) y_.values[in_y] = state.solution[in_flow];
  y_.values.update_ghost_values();
  if (!iterate(at_points, tolerance) && !(start_anew(at_points) && iterate(at_points, tolerance)))
    return false;
  for (const auto& [in_flow, in_y] : places_)
    if (d_.owned.is_element(in_flow)) state.solution[in_flow] = y_.values[in_y];
  state.solution.update_ghost_values();
  return true;
}

}  // namespace drumlin::continuum::fem
