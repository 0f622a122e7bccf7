#include "continuum/fem/flow_state.hpp"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "continuum/fem/detail/kept_state.hpp"
#include "continuum/fem/flow_field.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace fem {
namespace {

CellPlace place_of(const dealii::DoFHandler<2>::active_cell_iterator& cell) {
  const auto id = cell->id().to_binary<2>();
  return {id[0], id[1], id[2], id[3]};
}

/// Index among the kept cells; -1: not there.
long find(const FlowState& kept, const CellPlace& place) {
  const auto at = std::lower_bound(kept.cells.begin(), kept.cells.end(), place);
  return at != kept.cells.end() && *at == place ? at - kept.cells.begin() : -1;
}

// The fluidity follows from velocity and pressure.
bool is_kept(const Discretisation& d, unsigned int i) {
  return d.elements.system_to_component_index(i).first != fluidity_component;
}

FlowState own_cells(const SolvedLevel& level) {
  const auto& d = *level.discretisation;
  FlowState own;
  dealii::Vector<double> local(d.elements.n_dofs_per_cell());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_values(level.state.solution, local);
    own.cells.push_back(place_of(cell));
    own.centres.insert(own.centres.end(), {cell->center()[0], cell->center()[1]});
    for (unsigned int i = 0; i < local.size(); ++i)
      if (is_kept(d, i)) own.values.push_back(local[i]);
  }
  return own;
}

// g.u/u.u over the given velocities g of this rank: the factor that brings the kept ones nearest to them.
struct Projection {
  double product = 0, square = 0;
};
Projection onto_given(const Discretisation& d, const FieldVector& solution) {
  Projection sums;
  for (std::size_t k = 0; k < d.is_velocity.size(); ++k) {
    const auto i = d.owned.nth_index_in_set(k);
    if (!d.is_velocity[k] || !d.homogeneous.is_constrained(i) || d.conforming.is_constrained(i)) continue;
    sums.product += d.constraints.get_inhomogeneity(i) * solution[i];
    sums.square += solution[i] * solution[i];
  }
  return {d.sum(sums.product), d.sum(sums.square)};
}

// Inertia raises a surface by the square of the velocity. It stays where the cells cannot follow.
void scale_surface(SolvedLevel& level, double factor) {
  auto& d = *level.discretisation;
  const SurfaceShape kept = d.surface.value();
  SurfaceShape scaled = kept;
  for (double& c : scaled.coefficient) c *= factor;
  if (!d.move_surface(level.problem, scaled) && !d.move_surface(level.problem, kept))
    throw std::logic_error("cells that were valid are no more");
}

}  // namespace

FlowState kept_state(const SolvedLevel& level) {
  const auto parts = dealii::Utilities::MPI::all_gather(level.discretisation->mesh.get_communicator(), [&] {
    const FlowState own = own_cells(level);
    return std::make_pair(own.cells, std::make_pair(own.centres, own.values));
  }());
  FlowState all;
  for (const auto& [cells, numbers] : parts) {
    all.cells.insert(all.cells.end(), cells.begin(), cells.end());
    all.centres.insert(all.centres.end(), numbers.first.begin(), numbers.first.end());
    all.values.insert(all.values.end(), numbers.second.begin(), numbers.second.end());
  }
  std::vector<std::size_t> order(all.cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return all.cells[a] < all.cells[b]; });
  FlowState sorted;
  sorted.theta = level.state.theta;
  if (level.discretisation->surface) sorted.surface = level.discretisation->surface->coefficient;
  for (const std::size_t c : order) {
    constexpr int n = FlowState::values_per_cell;
    sorted.cells.push_back(all.cells[c]);
    sorted.centres.insert(sorted.centres.end(), &all.centres[2 * c], &all.centres[2 * c] + 2);
    sorted.values.insert(sorted.values.end(), &all.values[n * c], &all.values[n * c] + n);
  }
  return sorted;
}

bool fits(const Discretisation& d, const FlowState& kept) {
  bool all = d.mesh.n_global_active_cells() == kept.cells.size();
  if (all)
    for (const auto& cell : d.unknowns.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      const long c = find(kept, place_of(cell));
      all = all && c >= 0 &&
            std::hypot(cell->center()[0] - kept.centres[2 * c], cell->center()[1] - kept.centres[2 * c + 1]) <
                0.1 * cell->diameter();
    }
  return d.sum(all ? 0 : 1) == 0;
}

int refine_to(const FlowState& kept, const FlowSolverOptions& options, SolvedLevel& level) {
  auto& d = *level.discretisation;
  int mesh = 0;
  for (; !fits(d, kept); ++mesh) {
    if (mesh + 1 >= options.levels + options.further_levels ||
        d.mesh.n_global_active_cells() >= kept.cells.size())
      throw InputError(no_mesh_fits);
    d.refine(level.problem, level.state.solution);
  }
  return mesh;
}

void lay_down(const FlowState& kept, SolvedLevel& level) {
  auto& d = *level.discretisation;
  auto& solution = level.state.solution;
  solution = d.field();
  std::vector<dealii::types::global_dof_index> indices(d.elements.n_dofs_per_cell());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const auto c = static_cast<std::size_t>(find(kept, place_of(cell)));
    cell->get_dof_indices(indices);
    std::size_t next = c * FlowState::values_per_cell;
    for (unsigned int i = 0; i < indices.size(); ++i) {
      if (!is_kept(d, i)) continue;
      const double value = kept.values[next++];
      if (d.owned.is_element(indices[i])) solution[indices[i]] = value;
    }
  }
  solution.update_ghost_values();
  level.state.theta = kept.theta;
}

void take_over(const FlowState& kept, SolvedLevel& level) {
  const double theta = level.state.theta;
  lay_down(kept, level);
  auto& d = *level.discretisation;
  auto& solution = level.state.solution;
  if (level.problem.frame) solution -= frame_velocity(level.problem, d);  // kept in the laboratory
  const Projection sums = onto_given(d, solution);
  const double factor = sums.square > 0 && sums.product > 0 ? sums.product / sums.square : 1;
  for (std::size_t k = 0; k < d.is_velocity.size(); ++k)
    if (d.is_velocity[k]) solution.local_element(k) *= factor;
  if (d.surface && level.problem.inertia) scale_surface(level, factor * factor);
  d.constraints.distribute(solution);
  solution.update_ghost_values();
  if (std::holds_alternative<FixedSlope>(level.problem.slope)) level.state.theta = theta;
}

}  // namespace fem

FlowState FlowField::state() const { return fem::kept_state(*level_); }

}  // namespace drumlin::continuum
