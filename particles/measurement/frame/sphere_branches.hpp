#pragma once
// The sides of the contacts of spheres with all three components, which a view along y lacks.
#include "particles/bodies/snapshot.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"

namespace drumlin::particles {

/// Calls action(half branch), components x, z, y in the frame, for both sides of each contact that show.
template <class Action>
void each_sphere_branch(const FlowFrame& frame, const Snapshot& snapshot, const FlowSnapshot& in_frame,
                        Action action) {
  const SphereSlab& slab = *snapshot.spheres;
  const auto turned = [&](const std::array<double, 3>& v) {
    const auto [along, up] = frame.turned(v[0], v[1]);
    return Vector<3>{along, up, v[2]};
  };
  for (const SphereContact& contact : slab.contacts) {
    const Vector<3> normal = turned(contact.normal), force = turned(contact.force);
    for (const double sign : {1.0, -1.0}) {
      const std::int32_t grain = sign > 0 ? contact.i : contact.j;
      if (grain < 0 || !in_frame.shows(static_cast<std::size_t>(grain))) continue;
      const auto g = static_cast<std::size_t>(grain);
      HalfBranch<3> half{static_cast<std::uint32_t>(grain),
                         {in_frame.x[g], in_frame.z[g], slab.y[g]},
                         {},
                         {},
                         normal,
                         contact.j < 0};
      for (int a = 0; a < 3; ++a) {
        half.toward[a] = -sign * in_frame.radius[g] * normal[a];
        half.force[a] = sign * force[a];
      }
      action(half);
    }
  }
}

}  // namespace drumlin::particles
