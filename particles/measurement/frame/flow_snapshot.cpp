#include "particles/measurement/frame/flow_snapshot.hpp"

#include <cmath>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/cell_path.hpp"

namespace drumlin::particles {
namespace {

void add_contacts(const Snapshot& snapshot, const FlowFrame& frame, FlowSnapshot& result) {
  result.contacts.clear();
  result.contacts.reserve(snapshot.contacts.size());
  result.coordination.assign(snapshot.x.size(), 0);
  for (const SnapshotContact& contact : snapshot.contacts) {
    const double n_x = contact.normal_x, n_z = contact.normal_z;
    const double impulse_x = contact.impulse_n * n_x + contact.impulse_t * n_z;
    const double impulse_z = contact.impulse_n * n_z - contact.impulse_t * n_x;
    result.contacts.push_back({contact.i, contact.j, frame.along(n_x, n_z), frame.normal(n_x, n_z),
                               frame.along(impulse_x, impulse_z) / snapshot.time_step,
                               frame.normal(impulse_x, impulse_z) / snapshot.time_step});
    for (const std::int32_t grain : {contact.i, contact.j})
      if (grain >= 0) ++result.coordination[static_cast<std::size_t>(grain)];
  }
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
  const double cosine = std::cos(spin * window), sine = std::sin(spin * window);
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
    const double carried_x = (x - d_x) * cosine + (z - d_z) * sine;
    const double carried_z = (z - d_z) * cosine - (x - d_x) * sine;
    result.x[i] = (x - carried_x) / window;
    result.z[i] = (z - carried_z) / window;
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
  result.cell.reset();
  if (snapshot.cell) {  // the frame has the axes of the cell
    const Point up = period.image_velocity({period.offset, period.length_z});
    result.cell = {frame.z_of(0, period.origin_z),
                   period.length_z,
                   period.offset,
                   period.length,
                   up.x,
                   up.z,
                   period.image_velocity({period.length, 0}).x};
  }
  for (std::size_t i = 0; i < result.density.size(); ++i)
    result.density[i] /= mass_of_disc(snapshot.radius[i]);
  for (std::size_t i = 0; i < count; ++i) {
    MovingPoint grain{{snapshot.x[i], snapshot.z[i]}, {velocity.x[i], velocity.z[i]}};
    if (snapshot.cell) grain = first_image(period, grain);
    result.x[i] = frame.x_of(grain.at.x, grain.at.z);
    result.z[i] = frame.z_of(grain.at.x, grain.at.z);
    velocity.x[i] = frame.along(grain.velocity.x, grain.velocity.z);
    velocity.z[i] = frame.normal(grain.velocity.x, grain.velocity.z);
  }
  result.v_x = std::move(velocity.x);
  result.v_z = std::move(velocity.z);
  const double own_spin = snapshot.container_radius > 0 ? snapshot.wall_spin : 0.0;
  result.spin = snapshot.spin;
  for (double& spin : result.spin) spin -= own_spin;
  add_contacts(snapshot, frame, result);
  result.contacts_known = snapshot.contacts_known;
}

}  // namespace drumlin::particles
