#include "particles/measurement/frame/flow_snapshot.hpp"

#include <utility>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/cell_path.hpp"

namespace drumlin::particles {
namespace {

void add_contacts(const Snapshot& snapshot, const FlowFrame& frame, FlowSnapshot& result) {
  result.contacts.clear();
  result.contacts.reserve(snapshot.contacts.size());
  result.coordination.assign(snapshot.x.size(), 0);
  const auto add = [&](const auto& contact, double normal_x, double normal_z, double force_x, double force_z,
                       double per) {
    const auto [along, up] = frame.turned(force_x, force_z);
    const auto [across_x, across_z] = frame.turned(normal_x, normal_z);
    result.contacts.push_back({contact.i, contact.j, across_x, across_z, along / per, up / per});
    for (const std::int32_t grain : {contact.i, contact.j})
      if (grain >= 0) ++result.coordination[static_cast<std::size_t>(grain)];
  };
  for (const SnapshotContact& contact : snapshot.contacts) {
    const auto [impulse_x, impulse_z] = impulse_on_i(contact);
    add(contact, contact.normal_x, contact.normal_z, impulse_x, impulse_z, snapshot.time_step);
  }
  if (!snapshot.spheres) return;
  for (const SphereContact& contact : snapshot.spheres->contacts)
    add(contact, contact.normal[0], contact.normal[1], contact.force[0], contact.force[1],
        snapshot.spheres->depth);
}

}  // namespace

void relative_velocities(const Snapshot& snapshot, VelocityKind kind, RelativeVelocities& result) {
  const std::size_t count = snapshot.x.size();
  result.x.resize(count);
  result.z.resize(count);
  const double window = snapshot.velocity_window;
  const bool windowed = kind == VelocityKind::window && window > 0 && !snapshot.displacement_x.empty();
  const bool turning = snapshot.container_radius > 0 && snapshot.wall_spin != 0;
  const double spin = turning ? snapshot.wall_spin : 0;
  const Rigid turn(Pose{spin * window});
  for (std::size_t i = 0; i < count; ++i) {
    const double x = snapshot.x[i] - snapshot.container_x, z = snapshot.z[i] - snapshot.container_z;
    if (!windowed) {
      result.x[i] = snapshot.v_x[i] - spin * z;
      result.z[i] = snapshot.v_z[i] + spin * x;
      continue;
    }
    const double d_x = snapshot.displacement_x[i], d_z = snapshot.displacement_z[i];
    if (!turning) {
      result.x[i] = d_x / window;
      result.z[i] = d_z / window;
      continue;
    }
    // Where the grain was, carried along with the drum: the difference to where it is now is its own motion.
    const Point carried = turn.turned({x - d_x, z - d_z});
    result.x[i] = (x - carried.x) / window;
    result.z[i] = (z - carried.z) / window;
  }
}

void to_flow_frame(const Snapshot& snapshot, const FlowFrame& frame, VelocityKind kind,
                   FlowSnapshot& result) {
  const std::size_t count = snapshot.x.size();
  RelativeVelocities velocity{std::move(result.v_x), std::move(result.v_z)};
  relative_velocities(snapshot, kind, velocity);
  result.x.resize(count);
  result.z.resize(count);
  result.radius = snapshot.radius;
  result.density = snapshot.mass;
  const Period period = period_of(snapshot);
  result.cell = period;  // the frame has the axes of the cell
  const auto [origin_x, origin_z] = frame.place(period.origin, period.origin_z);
  result.cell.origin = origin_x, result.cell.origin_z = origin_z;
  for (std::size_t i = 0; i < result.density.size(); ++i)
    result.density[i] /= mass_of_disc(snapshot.radius[i]);
  for (std::size_t i = 0; i < count; ++i) {
    MovingPoint grain{{snapshot.x[i], snapshot.z[i]}, {velocity.x[i], velocity.z[i]}};
    if (snapshot.cell) grain = first_image(period, grain);
    const auto [x, z] = frame.place(grain.at.x, grain.at.z);
    const auto [v_x, v_z] = frame.turned(grain.velocity.x, grain.velocity.z);
    result.x[i] = x, result.z[i] = z;
    velocity.x[i] = v_x, velocity.z[i] = v_z;
  }
  result.v_x = std::move(velocity.x);
  result.v_z = std::move(velocity.z);
  const double own_spin = snapshot.container_radius > 0 ? snapshot.wall_spin : 0.0;
  result.spin = snapshot.spin;
  for (double& spin : result.spin) spin -= own_spin;
  add_contacts(snapshot, frame, result);
  result.contacts_known = snapshot.contacts_known;
  result.depth = snapshot.spheres ? snapshot.spheres->depth : 0;
  result.outside = snapshot.spheres ? snapshot.spheres->outside : std::vector<char>();
}

}  // namespace drumlin::particles
