#include "particles/measurement/forces/contact_forces.hpp"

#include <cmath>
#include <numbers>

namespace drumlin::particles {

void add_contact_forces(const LayerGrid& grid, const Snapshot& snapshot, ContactForces& forces) {
  const FlowFrame& frame = grid.frame;
  const double top = grid.z_max();
  for (const SnapshotContact& contact : snapshot.contacts) {
    const auto i = static_cast<std::size_t>(contact.i);
    const double reach = snapshot.radius[i];
    const double point_x = snapshot.x[i] - reach * contact.normal_x;
    const double point_z = snapshot.z[i] - reach * contact.normal_z;
    const double x = frame.x_of(point_x, point_z);
    double z = frame.z_of(point_x, point_z);
    if (grid.closed) {  // the same share of the height in every cell
      const double share = (z - snapshot.cell->z) / snapshot.cell->height;
      z = grid.z_min + (share - std::floor(share)) * (top - grid.z_min);
    }
    if (x < grid.x_min || x > grid.x_max || z < grid.z_min || z >= top) continue;
    double direction = std::atan2(frame.normal(contact.normal_x, contact.normal_z),
                                  frame.along(contact.normal_x, contact.normal_z));
    if (direction < 0) direction += std::numbers::pi;
    const bool with_wall = contact.j < 0;
    const double branch = with_wall ? reach : reach + snapshot.radius[static_cast<std::size_t>(contact.j)];
    (with_wall ? forces.with_walls : forces.between_grains)
        .push_back({static_cast<float>(z), static_cast<float>(contact.impulse_n / snapshot.time_step),
                    static_cast<float>(contact.impulse_t / snapshot.time_step), static_cast<float>(direction),
                    static_cast<float>(branch)});
  }
  ++forces.snapshots;
}

}  // namespace drumlin::particles
