#include "particles/measurement/history/wall_history.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/core/basics/no_value.hpp"

namespace drumlin::particles {
namespace {

constexpr double whole_turn = 2 * std::numbers::pi;

WallState empty_state(const Container* container, std::size_t sectors, double value) {
  WallState state;
  state.force_x = state.force_z = value;
  if (!container) return state;
  state.torque = value;
  for (std::size_t s = 0; s < sectors; ++s) {
    const auto n = static_cast<double>(sectors);
    const double from = whole_turn * (static_cast<double>(s) / n - 0.5);
    state.sectors.push_back({from, from + whole_turn / n, value, value});
  }
  return state;
}

/// Adds the force (f_x, f_z) of the wall on a grain, at a point that stands (x, z) from the centre.
void add_to_container(double x, double z, double f_x, double f_z, double radius, WallState& state) {
  const double angle = std::atan2(x, -z),
               length = whole_turn * radius / static_cast<double>(state.sectors.size());
  const auto number =
      static_cast<std::size_t>((angle / whole_turn + 0.5) * static_cast<double>(state.sectors.size()));
  WallSector& sector = state.sectors[std::min(number, state.sectors.size() - 1)];
  const double distance = std::hypot(x, z), n_x = -x / distance, n_z = -z / distance;
  // Clockwise along the wall: (z, -x)/distance.
  const double shear = (f_x * z - f_z * x) / distance;
  sector.normal += (f_x * n_x + f_z * n_z) / length;
  sector.shear += shear / length;
  state.torque -= shear * distance;
}

}  // namespace

std::vector<WallState> wall_states(const Snapshot& snapshot, std::size_t walls,
                                   std::span<const int> wall_of_shape, std::span<const Shape> shapes,
                                   std::size_t sectors) {
  std::vector<const Container*> container(walls, nullptr);
  for (std::size_t s = 0; s < shapes.size(); ++s)
    if (const auto* round = std::get_if<Container>(&shapes[s]))
      container[static_cast<std::size_t>(wall_of_shape[s])] = round;
  std::vector<WallState> states;
  for (const Container* round : container)
    states.push_back(empty_state(round, sectors, snapshot.contacts_known ? 0 : no_value));
  for (const SnapshotContact& contact : snapshot.contacts) {
    if (contact.j >= 0) continue;
    const auto wall = static_cast<std::size_t>(wall_of_shape[static_cast<std::size_t>(-1 - contact.j)]);
    WallState& state = states[wall];
    auto [f_x, f_z] = impulse_on_i(contact);
    f_x /= snapshot.time_step, f_z /= snapshot.time_step;
    state.force_x -= f_x;
    state.force_z -= f_z;
    if (const Container* round = container[wall]) {
      const auto i = static_cast<std::size_t>(contact.i);
      const double x = snapshot.x[i] - snapshot.radius[i] * contact.normal_x - round->center.x;
      const double z = snapshot.z[i] - snapshot.radius[i] * contact.normal_z - round->center.z;
      add_to_container(x, z, f_x, f_z, round->radius, state);
    }
  }
  return states;
}

}  // namespace drumlin::particles
