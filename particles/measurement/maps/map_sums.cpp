#include "particles/measurement/maps/map_sums.hpp"

#include <cmath>
#include <vector>

#include "particles/bodies/cell_path.hpp"
#include "particles/measurement/frame/accumulate.hpp"
#include "particles/measurement/frame/spheres_in_frame.hpp"

namespace drumlin::particles {

void MapNode::add_centre(const KernelWeight& at, const GrainSample<2>& grain) {
  const auto [phi, phi_x, phi_z] = at;
  const auto [u_x, u_z] = grain.laboratory_velocity;
  const double mass = grain.mass(), m_x = mass * u_x, m_z = mass * u_z;
  NodeMoments::add_centre(phi, grain);
  carried.add(at, {mass, mass * grain.velocity[0], mass * grain.velocity[1], m_x, m_z});
  for (int a = 0; a < 2; ++a) force[a] += phi * grain.force[a];
  flux_divergence[0] += phi_x * (m_x * u_x) + phi_z * (m_x * u_z);
  flux_divergence[1] += phi_x * (m_x * u_z) + phi_z * (m_z * u_z);
}

CoarseGraining coarse_graining(const FlowFrame& frame, double x_from, double x_to, double z_from, double z_to,
                               double spacing, double width, double period, bool closed) {
  CoarseGraining graining{frame, grid_over(x_from, x_to, z_from, z_to, spacing, width), width, period};
  MapGrid& grid = graining.grid;
  if (closed) {
    grid.rows = static_cast<std::size_t>(std::max(1.0, std::ceil((z_to - z_from) / spacing)));
    grid.spacing_z = (z_to - z_from) / static_cast<double>(grid.rows);
    grid.z_first = z_from + grid.spacing_z / 2;
  }
  if (period > 0) {
    grid.columns = static_cast<std::size_t>(std::max(1.0, std::ceil(period / spacing)));
    grid.spacing_x = period / static_cast<double>(grid.columns);
    grid.x_first = x_from;
    if (closed) graining.period = 0;
  }
  return graining;
}

MapSums empty_sums(const CoarseGraining& graining) { return {NodeTiles<MapNode>(graining.grid), {}, {}}; }

void add_snapshot(const CoarseGraining& graining, const Snapshot& snapshot, const FlowSnapshot& in_frame,
                  MapSums& sums) {
  const KernelGrid binning(graining, in_frame.cell);
  const FlowFrame& frame = graining.frame;
  const Period period = period_of(snapshot);
  std::vector<Vector<2>> force(in_frame.x.size());  // of all contacts, per grain
  in_frame.each_half_branch([&](const HalfBranch<2>& branch) {
    for (int a = 0; a < 2; ++a) force[branch.grain][a] += branch.force[a];
    add_branch(branch, binning, sums.nodes);
  });
  for (std::size_t i = 0; i < in_frame.x.size(); ++i) {
    if (!in_frame.shows(i)) continue;
    Point velocity{snapshot.v_x[i], snapshot.v_z[i]};
    if (snapshot.cell) velocity = first_image(period, grain_of(snapshot, i)).velocity;
    GrainSample<2> grain = in_frame.grain(i);
    grain.laboratory_velocity = frame.turned(velocity.x, velocity.z);
    grain.force = force[i];
    add_grain(grain, binning, sums.nodes);
  }
  if (snapshot.spheres) {
    if (sums.space.size() == 0) sums.space = NodeTiles<SpaceNode>(graining.grid);
    accumulate_spheres(frame, snapshot, in_frame, binning, sums.space);
  }
  MapSums::Snapshots& known = sums.snapshots;
  known.add(in_frame);
  const auto [gravity_x, gravity_z] = frame.turned(snapshot.gravity_x, snapshot.gravity_z);
  known.gravity_x += gravity_x;
  known.gravity_z += gravity_z;
}

}  // namespace drumlin::particles
