#include "particles/measurement/maps/displacement_sums.hpp"

#include <cmath>

namespace drumlin::particles {
namespace {

/// Of the drum's axes, clockwise; 0 without a drum that turns.
double angle_of(const Snapshot& s) { return s.container_radius > 0 && s.wall_spin != 0 ? s.wall_angle : 0; }

}  // namespace

void DisplacementDepositor::add_pair(const Snapshot& before, const Snapshot& now, MapSums& sums) const {
  const FlowFrame& frame = graining_.frame;
  const double time = now.time - before.time;
  const Rigid back_before(Pose{-angle_of(before)}), back_now(Pose{-angle_of(now)}),
      half_turn(Pose{(angle_of(before) + angle_of(now)) / 2});
  std::optional<CellPath> path;
  if (before.cell && now.cell) path.emplace(*cell_instant(before), *cell_instant(now));
  const KernelGrid binning(graining_, path ? path->half_way() : Period{});
  const auto* slab = now.spheres && !now.spheres->outside.empty() ? &now.spheres->outside : nullptr;
  for (const auto& [then, i] : same_grains(before, now)) {
    if (slab && (*slab)[i] != 0) continue;
    const MovingPoint from = grain_of(before, then), to = grain_of(now, i);
    const Point was = back_before.turned({from.at.x - before.container_x, from.at.z - before.container_z});
    const Point is = back_now.turned({to.at.x - now.container_x, to.at.z - now.container_z});
    Point by{is.x - was.x, is.z - was.z};
    if (path)
      by = path->displacement(from, to);
    else if (const double period = now.period_x; period > 0)
      by.x -= period * std::round((by.x - time * (from.velocity.x + to.velocity.x) / 2) / period);
    const Point half_way = half_turn.turned(path ? Point{was.x + by.x / 2, was.z + by.z / 2}
                                                 : Point{is.x - by.x / 2, is.z - by.z / 2});
    by = half_turn.turned(by);
    const double mass = mass_of(now, i);
    const Vector<2> moved = frame.turned(by.x, by.z);
    const Vector<2> place = frame.place(now.container_x + half_way.x, now.container_z + half_way.z);
    binning.each_image(place, 0, [&](const Vector<2>& at) {
      // The cell moves its images.
      const Point more = path ? path->change({at[0] - place[0], at[1] - place[1]}) : Point{};
      const std::array<double, 3> moments{mass * time, mass * (moved[0] + more.x),
                                          mass * (moved[1] + more.z)};
      binning.each_node(at, [&](MapPlace place_of_node, const KernelWeight& weight) {
        sums.nodes[place_of_node].displaced.add(weight, moments);
      });
    });
  }
  sums.snapshots.pairs += 1;
  sums.snapshots.time += time;
}

void DisplacementDepositor::add(const Snapshot& snapshot, MapSums& sums) {
  if (last_ && snapshot.time > last_->time && (!snapshot.id.empty() || snapshot.radius == last_->radius))
    add_pair(*last_, snapshot, sums);
  last_ = snapshot;
  last_->contacts = {};
}

}  // namespace drumlin::particles
