#pragma once
// Spheres and the sides of their contacts with all three components, which a view along y lacks: x, z, y in
// the frame, per depth of the slab as in the view.
#include "particles/bodies/snapshot.hpp"
#include "particles/measurement/frame/accumulate.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"

namespace drumlin::particles {

inline GrainSample<3> sphere_sample(const FlowFrame& frame, const Snapshot& snapshot,
                                    const FlowSnapshot& in_frame, std::size_t i) {
  const SphereSlab& slab = *snapshot.spheres;
  const GrainSample<2> seen = in_frame.grain(i);
  const auto [v_x, v_z] = frame.turned(snapshot.v_x[i], snapshot.v_z[i]);
  GrainSample<3> sphere{i, {seen.at[0], seen.at[1], slab.y[i]}};
  sphere.velocity = {seen.velocity[0], seen.velocity[1], slab.v_y[i]};
  sphere.laboratory_velocity = {v_x, v_z, slab.v_y[i]};
  sphere.radius = seen.radius, sphere.density = seen.density, sphere.contacts = seen.contacts;
  sphere.spin = seen.spin, sphere.depth = seen.depth;
  return sphere;
}

/// Calls action(half branch) for both sides of each contact that show.
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
        half.force[a] = sign * force[a] / slab.depth;
      }
      action(half);
    }
  }
}

/// As accumulate(): all spheres, then all sides of their contacts.
template <class Binning, class Bins>
void accumulate_spheres(const FlowFrame& frame, const Snapshot& snapshot, const FlowSnapshot& in_frame,
                        const Binning& binning, Bins& bins) {
  for (std::size_t i = 0; i < in_frame.x.size(); ++i)
    if (in_frame.shows(i)) add_grain(sphere_sample(frame, snapshot, in_frame, i), binning, bins);
  each_sphere_branch(frame, snapshot, in_frame,
                     [&](const HalfBranch<3>& half) { add_branch(half, binning, bins); });
}

}  // namespace drumlin::particles
