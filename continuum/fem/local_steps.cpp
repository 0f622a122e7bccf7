#include "continuum/fem/detail/local_steps.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/sparsity_tools.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "continuum/fem/detail/cell_shapes.hpp"
#include "continuum/fem/detail/direct_solver.hpp"
#include "continuum/fem/detail/step_length.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum::fem {
namespace {

using Index = dealii::types::global_dof_index;

// An unknown stands out whose squared residual is so many times the mean: at most one in so many does.
constexpr double stands_out = 20;
// Share of the squared residual that such unknowns have to hold.
constexpr double most_of_it = 0.5;
// Cells around them that take part.
constexpr int layers = 2;
// Where to end: the rest depends on the cells around, which move with the steps of all unknowns.
constexpr double enough_of_first = 0.1;
constexpr int most_steps = 10;
// Unknowns that take part, of all of them; and how many cost nothing.
constexpr double largest_share = 0.2;
constexpr Index always_small = 5000;
constexpr double linear_tolerance = 1e-6;

bool has(const FieldVector& field, Index i) {
  return field.in_local_range(i) || field.get_partitioner()->is_ghost_entry(i);
}

/// Counts at each unknown the cells of this and other ranks that have it, of those that are `chosen` or of
/// all others.
FieldVector cells_with_unknowns(const Discretisation& d, const std::vector<OwnCell>& cells,
                                const std::vector<char>& chosen, bool of_others) {
  FieldVector count = d.field();
  std::vector<Index> indices(d.elements.n_dofs_per_cell());
  for (const OwnCell& at : cells) {
    if ((chosen[at.number] != 0) == of_others) continue;
    at.cell->get_dof_indices(indices);
    for (const Index i : indices) {
      count(i) += 1;
      if (!of_others) continue;
      // What unknowns of other cells follow from belongs to these, too.
      if (const auto* entries = d.homogeneous.get_constraint_entries(i))
        for (const auto& [master, weight] : *entries)
          if (has(count, master)) count(master) += 1;
    }
  }
  count.compress(dealii::VectorOperation::add);
  count.update_ghost_values();
  return count;
}

/// The unknowns of some cells, on any rank, numbered among themselves, and Newton steps of those that belong
/// to none but these cells. All calls are collective.
class Patch {
 public:
  /// Around the unknowns whose residuals are beyond the bound.
  Patch(const FlowProblem& problem, const Discretisation& d, const Setting& setting,
        const FieldVector& residual, double bound);
  /// Steps until the residual of the patch has fallen. False where none was taken.
  bool settle(State& state);
  /// Not where it is much of a flow that costs something.
  bool is_worth_it() const {
    return owned_.size() <= always_small ||
           static_cast<double>(owned_.size()) <= largest_share * static_cast<double>(d_.unknowns.n_dofs());
  }

 private:
  void choose_cells(const FieldVector& residual, double bound);
  void number_unknowns();
  void lay_out();
  void constrain(const dealii::IndexSet& relevant, const FieldVector& others);
  std::optional<Index> number_of(Index unknown) const;
  double assemble(const State& state, bool with_tangent);
  double slope() const;
  bool step(State& state);
  void advance_dual(double alpha, State& state) const;

  const FlowProblem& problem_;
  const Discretisation& d_;
  const Setting& setting_;
  std::vector<OwnCell> cells_;                // of this rank: all of them, then those of the patch
  std::vector<char> chosen_;                  // of all of them
  dealii::IndexSet owned_;                    // numbers of this rank
  FieldVector numbers_;                       // 1 + the number in the patch; 0: not of it
  std::vector<std::vector<Index>> of_cells_;  // numbers of the unknowns of the patch's cells
  dealii::AffineConstraints<double> constraints_;
  SystemMatrix tangent_;
  FieldVector residual_, correction_;
  FieldVector step_;  // the correction among all unknowns
  DirectSolver factors_;
};

Patch::Patch(const FlowProblem& problem, const Discretisation& d, const Setting& setting,
             const FieldVector& residual, double bound)
    : problem_(problem), d_(d), setting_(setting), step_(d.field()) {
  choose_cells(residual, bound);
  number_unknowns();
}

void Patch::choose_cells(const FieldVector& residual, double bound) {
  std::vector<Index> indices(d_.elements.n_dofs_per_cell());
  FieldVector touched = d_.field();
  for (std::size_t k = 0; k < residual.locally_owned_size(); ++k)
    if (std::abs(residual.local_element(k)) > bound) touched.local_element(k) = 1;
  touched.update_ghost_values();
  for (const auto& cell : d_.unknowns.active_cell_iterators())
    if (cell->is_locally_owned()) cells_.push_back({cell, cells_.size()});
  chosen_.assign(cells_.size(), 0);
  for (int layer = 0; layer <= layers; ++layer) {
    if (layer > 0) touched = cells_with_unknowns(d_, cells_, chosen_, false);
    for (const OwnCell& at : cells_) {
      at.cell->get_dof_indices(indices);
      for (const Index i : indices)
        if (touched(i) > 0) chosen_[at.number] = 1;
    }
  }
}

void Patch::number_unknowns() {
  const FieldVector of_patch = cells_with_unknowns(d_, cells_, chosen_, false);
  std::uint64_t count = 0;
  for (std::size_t k = 0; k < of_patch.locally_owned_size(); ++k) count += of_patch.local_element(k) > 0;
  std::uint64_t before = 0;
  MPI_Comm ranks = d_.mesh.get_communicator();
  MPI_Exscan(&count, &before, 1, MPI_UINT64_T, MPI_SUM, ranks);
  if (dealii::Utilities::MPI::this_mpi_process(ranks) == 0) before = 0;
  const std::uint64_t all = dealii::Utilities::MPI::sum(count, ranks);
  numbers_ = d_.field();
  std::uint64_t next = before;
  for (std::size_t k = 0; k < of_patch.locally_owned_size(); ++k)
    if (of_patch.local_element(k) > 0) numbers_.local_element(k) = static_cast<double>(++next);
  numbers_.update_ghost_values();
  owned_ = dealii::IndexSet(all);
  owned_.add_range(before, before + count);
}

std::optional<Index> Patch::number_of(Index unknown) const {
  if (!has(numbers_, unknown) || numbers_(unknown) == 0) return std::nullopt;
  return static_cast<Index>(numbers_(unknown)) - 1;
}

void Patch::lay_out() {
  const FieldVector others = cells_with_unknowns(d_, cells_, chosen_, true);
  std::erase_if(cells_, [&](const OwnCell& at) { return !chosen_[at.number]; });
  dealii::IndexSet relevant = owned_;
  std::vector<Index> indices(d_.elements.n_dofs_per_cell());
  for (const OwnCell& at : cells_) {
    at.cell->get_dof_indices(indices);
    for (Index& i : indices) {
      if (const auto* entries = d_.homogeneous.get_constraint_entries(i))
        for (const auto& [master, weight] : *entries)  // maybe of no cell of this rank
          if (const auto number = number_of(master)) relevant.add_index(*number);
      i = *number_of(i);
    }
    relevant.add_indices(indices.begin(), indices.end());
    of_cells_.push_back(indices);
  }
  constrain(relevant, others);
  dealii::DynamicSparsityPattern pattern(owned_.size(), owned_.size(), relevant);
  for (const std::vector<Index>& numbers : of_cells_)
    constraints_.add_entries_local_to_global(numbers, pattern, false);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, owned_, d_.mesh.get_communicator(), relevant);
  tangent_.reinit(owned_, owned_, pattern, d_.mesh.get_communicator());
  residual_.reinit(owned_, relevant, d_.mesh.get_communicator());
  correction_.reinit(residual_);
}

// Of a correction: what belongs to other cells, too, stays.
void Patch::constrain(const dealii::IndexSet& relevant, const FieldVector& others) {
  constraints_.reinit(relevant);
  for (const Index i : d_.relevant) {
    const auto number = number_of(i);
    if (!number || !relevant.is_element(*number)) continue;
    const bool stays = others(i) > 0;
    if (!stays && !d_.homogeneous.is_constrained(i)) continue;
    constraints_.add_line(*number);
    if (stays) continue;
    for (const auto& [master, weight] : *d_.homogeneous.get_constraint_entries(i))
      if (const auto of_patch = number_of(master); of_patch && relevant.is_element(*of_patch))
        constraints_.add_entry(*number, *of_patch, weight);
  }
  constraints_.close();
}

// Returns the norm of the residual.
double Patch::assemble(const State& state, bool with_tangent) {
  residual_ = 0;
  if (with_tangent) tangent_ = 0;
  assemble_cells(problem_, d_, setting_, state, cells_, with_tangent,
                 [&](std::size_t k, const CellContribution& of_cell) {
                   constraints_.distribute_local_to_global(of_cell.residual, of_cells_[k], residual_);
                   if (with_tangent)
                     constraints_.distribute_local_to_global(of_cell.tangent, of_cells_[k], tangent_);
                 });
  residual_.compress(dealii::VectorOperation::add);
  if (with_tangent) tangent_.compress(dealii::VectorOperation::add);
  return residual_.l2_norm();
}

// R.du over the velocities, of the residual that has been assembled last.
double Patch::slope() const {
  double sum = 0;
  for (std::size_t k = 0; k < numbers_.locally_owned_size(); ++k)
    if (const double number = numbers_.local_element(k); number > 0 && d_.is_velocity[k])
      sum += residual_(static_cast<Index>(number) - 1) * step_.local_element(k);
  return d_.sum(sum);
}

// From a state that is still where the step begins.
void Patch::advance_dual(double alpha, State& state) const {
  CellShapes shapes(d_);
  dealii::Vector<double> local(shapes.n), change(shapes.n);
  for (const OwnCell& at : cells_) {
    shapes.reinit(&d_.points[at.number * d_.quadrature.size()]);
    at.cell->get_dof_values(state.solution, local);
    at.cell->get_dof_values(step_, change);
    change *= alpha;
    fem::advance_dual(shapes, setting_.regularisation, local, change,
                      &state.dual[at.number * d_.quadrature.size()]);
  }
}

// From a state whose system is assembled to another whose residual is. False where there is no step.
bool Patch::step(State& state) {
  FieldVector rhs = residual_;
  rhs *= -1;
  try {
    factors_.factorise(tangent_);
    if (!(factors_.solve(rhs, correction_) <= linear_tolerance)) return false;
  } catch (const NotConvergedError&) {  // singular
    return false;
  }
  step_ = 0;
  for (std::size_t k = 0; k < numbers_.locally_owned_size(); ++k)
    if (const double number = numbers_.local_element(k); number > 0)
      step_.local_element(k) = correction_(static_cast<Index>(number) - 1);
  d_.homogeneous.distribute(step_);
  step_.update_ghost_values();
  const StepLength length = step_length(slope(), [&](double share) {
    assemble(moved(state, step_, 0, share), false);
    return slope();
  });
  advance_dual(length.share, state);
  state = moved(state, step_, 0, length.share);
  if (!length.asked_last) assemble(state, false);
  return true;
}

bool Patch::settle(State& state) {
  lay_out();
  const double first = assemble(state, true);
  if (!step(state)) return false;
  for (int taken = 1; taken < most_steps && residual_.l2_norm() > enough_of_first * first; ++taken) {
    assemble(state, true);
    if (!step(state)) break;
  }
  return true;
}

}  // namespace

std::optional<State> locally_settled(const FlowProblem& problem, const Discretisation& d,
                                     const Setting& setting, const State& state,
                                     const FieldVector& residual) {
  const double size = residual.l2_norm();
  const double bound = size * std::sqrt(stands_out / static_cast<double>(d.unknowns.n_dofs()));
  double held = 0;
  for (std::size_t k = 0; k < residual.locally_owned_size(); ++k)
    if (const double r = residual.local_element(k); std::abs(r) > bound) held += r * r;
  if (!(d.sum(held) >= most_of_it * size * size)) return std::nullopt;
  Patch patch(problem, d, setting, residual, bound);
  State settled = state;
  if (!patch.is_worth_it() || !patch.settle(settled)) return std::nullopt;
  return settled;
}

}  // namespace drumlin::continuum::fem
