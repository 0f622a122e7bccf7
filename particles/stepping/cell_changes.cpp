// The moving cell of a simulation between its steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/longest_step.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {
namespace {

/// In a shorter cell a grain would meet the same neighbour on both sides.
void refuse_short_cell(const CellState& cell, const Bodies& bodies) {
  const double least = 6 * *std::max_element(bodies.radius.begin(), bodies.radius.end());
  if (cell.length_x > least && cell.length_z > least) return;
  throw NotConvergedError("the cell has become shorter than 3 of the largest grains");
}

/// Pressures may drive rates that no key names.
void refuse_long_strain(const CellState& cell, double h) {
  const double strain = h * std::max({std::abs(cell.rate_x), std::abs(cell.rate_z), std::abs(cell.shear)});
  // Given rates of that size are refused before: rounding must not stop a run.
  if (strain <= longest_strain * (1 + 1e-3)) return;
  throw NotConvergedError(
      fmt::format("the cell is strained by {:.3g} in a step, more than {}: time_step_s is too large", strain,
                  longest_strain));
}

}  // namespace

MovingCell Simulation::begin_cell_step(double h) {
  CellState& cell = *state_.cell;
  refuse_short_cell(cell, state_.bodies);
  const CellResponse response = response_of(setting_.cell, cell, state_.bodies);
  const double before = state_.energy ? kinetic_energy(state_.bodies) : 0;
  drive_cell(setting_.cell, response, h, cell, state_.bodies);
  refuse_long_strain(cell, h);
  if (state_.energy) add_cell_work(kinetic_energy(state_.bodies) - before, *state_.energy);
  return {cell, response};
}

/// Velocities follow the images; grains come back into the cell, and with them where they were at the
/// beginning of velocity windows.
void Simulation::end_cell_step(const CellState& begun, double h) {
  CellState& cell = *state_.cell;
  const double before = state_.energy ? kinetic_energy(state_.bodies) : 0;
  follow_images(begun, cell, state_.bodies);
  const std::vector<Point> shifts = wrap_grains(cell, state_.bodies);
  if (state_.energy) {
    state_.energy->kinetic = kinetic_energy(state_.bodies);
    add_cell_work(state_.energy->kinetic - before, *state_.energy);
  }
  if (shifts.empty()) return;
  const Period period = period_of(cell);
  for (auto& mark : state_.marks) {
    const double since = state_.time() + h - mark.time;
    for (std::size_t b = 0; b < shifts.size(); ++b) {
      const Point velocity = period.image_velocity(shifts[b]);
      mark.x[b] += shifts[b].x - since * velocity.x;
      mark.z[b] += shifts[b].z - since * velocity.z;
    }
  }
}

}  // namespace drumlin::particles
