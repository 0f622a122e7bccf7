#include "particles/stepping/snapshot_of_state.hpp"

#include <algorithm>
#include <optional>
#include <variant>

namespace drumlin::particles {

std::vector<SnapshotContact> one_for_each_pair(std::vector<SnapshotContact> contacts) {
  std::stable_sort(contacts.begin(), contacts.end(), [](const SnapshotContact& a, const SnapshotContact& b) {
    return a.i != b.i ? a.i < b.i : a.j < b.j;
  });
  std::vector<SnapshotContact> sums;
  sums.reserve(contacts.size());
  for (const SnapshotContact& contact : contacts)
    if (sums.empty() || sums.back().i != contact.i || sums.back().j != contact.j) {
      sums.push_back(contact);
    } else {
      sums.back().impulse_n += contact.impulse_n;
      sums.back().impulse_t += contact.impulse_t;
    }
  return sums;
}

namespace {

/// Of the rotations among a wall's motions; nothing if there are none.
std::optional<double> spin_of(const std::vector<Motion>& motions) {
  std::optional<double> spin;
  for (const Motion& motion : motions)
    if (const auto* turning = std::get_if<Turning>(&motion)) spin = spin.value_or(0) + turning->spin;
  return spin;
}

}  // namespace

Snapshot snapshot_of(const StateInScene& in, SimulationState& state) {
  Snapshot s;
  const Bodies& bodies = state.bodies;
  s.step = state.step;
  s.time = state.time();
  s.time_step = in.plan.stages[state.stage].time_step;
  s.scales = in.scales;
  for (std::size_t w = 0; w < in.walls.names.size(); ++w)
    if (const auto spin = spin_of(in.walls.motions[w])) {
      s.wall_angle = in.walls.pose(static_cast<int>(w), state.time_in_stage, state.driven).angle;
      s.wall_spin = *spin;
      break;
    }
  for (const Shape& shape : in.walls.shapes_at(state.time_in_stage, state.driven))
    if (const auto* container = std::get_if<Container>(&shape)) {
      s.container_x = container->center.x, s.container_z = container->center.z,
      s.container_radius = container->radius;
      break;
    }
  s.wall_open = std::vector<std::int32_t>(in.walls.open.begin(), in.walls.open.end());
  if (opens_walls(in.scene)) s.wall_open.resize(in.walls.names.size());
  if (moves_walls_by_force(in.scene) || ends_stages_early(in.scene))
    for (std::size_t w = 0; w < in.walls.names.size(); ++w) {
      const Pose pose = in.walls.pose(static_cast<int>(w), state.time_in_stage, state.driven);
      s.wall_pose_angle.push_back(pose.angle);
      s.wall_pose_x.push_back(pose.x), s.wall_pose_z.push_back(pose.z);
    }
  s.gravity_x = in.gravity.x, s.gravity_z = in.gravity.z;
  const Period period = state.cell ? period_of(*state.cell) : in.period;
  s.period_x = period.length;
  if (!period.open_z())
    s.cell = {period.origin, period.origin_z, period.length_z, period.offset,
              period.rate_x, period.rate_z,   period.shear};
  s.x = bodies.x, s.z = bodies.z, s.v_x = bodies.v_x, s.v_z = bodies.v_z, s.radius = bodies.radius,
  s.spin = bodies.spin, s.id = bodies.id;
  if (in.own_masses || has_own_masses(bodies))
    for (const double inverse : bodies.inverse_mass) s.mass.push_back(1 / inverse);
  while (!state.marks.empty() && state.marks.front().snapshot_step < state.step) state.marks.pop_front();
  if (!state.marks.empty() && state.marks.front().snapshot_step == state.step) {
    const auto& mark = state.marks.front();
    s.velocity_window = state.time() - mark.time;
    s.displacement_x.resize(bodies.count());
    s.displacement_z.resize(bodies.count());
    for (std::size_t b = 0; b < bodies.count(); ++b) {
      s.displacement_x[b] = bodies.x[b] - mark.x[b];
      s.displacement_z[b] = bodies.z[b] - mark.z[b];
    }
    state.marks.pop_front();
  }
  return s;
}

}  // namespace drumlin::particles
