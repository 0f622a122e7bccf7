#include "particles/measurement/maps/displacement_sums.hpp"

#include <cmath>
#include <utility>

#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
void DisplacementDepositor::find_ends(const Snapshot& snapshot, Ends& ends) {
  const bool turning = snapshot.container_radius > 0 && snapshot.wall_spin != 0;
  const std::size_t count = snapshot.x.size();
  ends.time = snapshot.time;
  ends.angle = turning ? snapshot.wall_angle : 0;
  ends.radius = snapshot.radius;
  ends.id = snapshot.id;
  ends.v_x.clear();
  if (snapshot.period_x > 0) ends.v_x = snapshot.v_x;
  ends.cell = cell_instant(snapshot);
  if (ends.cell) ends.v_z = snapshot.v_z;
  ends.x.resize(count);
  ends.z.resize(count);
  const double cosine = std::cos(ends.angle), sine = std::sin(ends.angle);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = snapshot.x[i] - snapshot.container_x, z = snapshot.z[i] - snapshot.container_z;
    ends.x[i] = x * cosine - z * sine;  // turned back, anticlockwise
    ends.z[i] = x * sine + z * cosine;
  }
}

void DisplacementDepositor::add_pair(const Ends& from, const Ends& to, const Snapshot& snapshot,
                                     MapSums& sums) const {
  const FlowFrame& frame = graining_.frame;
  const double time = to.time - from.time, angle = (from.angle + to.angle) / 2;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  std::optional<CellPath> path;
  std::optional<FlowCell> images;
  if (from.cell && to.cell) {
    path.emplace(*from.cell, *to.cell);
    const Period& half_way = path->half_way();
    images = FlowCell{0, half_way.length_z, half_way.offset, half_way.length, 0, 0, 0};
  }
  const KernelGrid binning(graining_, images);
  for (const auto& [before, i] : same_grains(from.id, from.x.size(), to.id, to.x.size())) {
    double d_x = to.x[i] - from.x[before], d_z = to.z[i] - from.z[before];
    if (path) {
      const Point d =
          path->displacement({{from.x[before], from.z[before]}, {from.v_x[before], from.v_z[before]}},
                             {{to.x[i], to.z[i]}, {to.v_x[i], to.v_z[i]}});
      d_x = d.x, d_z = d.z;
    } else if (const double period = snapshot.period_x; period > 0)
      d_x -= period * std::round((d_x - time * (from.v_x[before] + to.v_x[i]) / 2) / period);
    double x = to.x[i] - d_x / 2, z = to.z[i] - d_z / 2;
    if (path) x = from.x[before] + d_x / 2, z = from.z[before] + d_z / 2;
    const double lab_x = x * cosine + z * sine, lab_z = z * cosine - x * sine;
    const double moved_x = d_x * cosine + d_z * sine, moved_z = d_z * cosine - d_x * sine;
    const double mass = mass_of(snapshot, i);
    const std::array<double, 3> moments{mass * time, mass * frame.along(moved_x, moved_z),
                                        mass * frame.normal(moved_x, moved_z)};
    const Vector<2> place{frame.x_of(snapshot.container_x + lab_x, snapshot.container_z + lab_z),
                          frame.z_of(snapshot.container_x + lab_x, snapshot.container_z + lab_z)};
    binning.each_image(place, 0, [&](double columns, double rows, const Vector<2>& at) {
      std::array<double, 3> of_image = moments;
      if (path) {  // the cell moves its images
        const Point more =
            path->change({columns * images->length + rows * images->offset, rows * images->height});
        of_image[1] += mass * more.x, of_image[2] += mass * more.z;
      }
      binning.each_node(at, [&](MapPlace place_of_node, const KernelWeight& weight) {
        MapNode& node = sums.nodes[place_of_node];
        add_times(weight.phi, of_image, node.moved);
        add_times(weight.phi_x, of_image, node.moved_slope_x);
        add_times(weight.phi_z, of_image, node.moved_slope_z);
      });
    });
  }
  sums.snapshots.pairs += 1;
  sums.snapshots.time += time;
}

void DisplacementDepositor::add(const Snapshot& snapshot, MapSums& sums) {
  Ends ends;
  find_ends(snapshot, ends);
  if (last_ && ends.time > last_->time && (!ends.id.empty() || ends.radius == last_->radius))
    add_pair(*last_, ends, snapshot, sums);
  last_ = std::move(ends);
}

}  // namespace drumlin::particles
