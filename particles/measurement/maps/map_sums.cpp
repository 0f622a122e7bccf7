#include "particles/measurement/maps/map_sums.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "coupling/common/errors.hpp"
#include "particles/bodies/cell_path.hpp"
#include "particles/measurement/maps/node_canvas.hpp"

namespace drumlin::particles {
namespace {

using Canvas = NodeCanvas<MapNode>;

/// The integral of the kernel along a half branch by two Gauss points in each of its pieces. Pieces up to 0.6
/// widths long keep its error below 1e-3 of the kernel's greatest value (test MapSums).
constexpr double longest_piece = 0.6;
constexpr double gauss_offset = 0.28867513459481288;  // sqrt(3)/6 from the middle of a piece of length 1

void add_half_branch(const HalfBranch<2>& branch, double width, const std::optional<FlowCell>& cell,
                     Canvas& canvas) {
  const double length = std::hypot(branch.toward[0], branch.toward[1]);
  const double pieces = std::max(1.0, std::ceil(length / (longest_piece * width)));
  const double share = -1 / (2 * pieces);  // b points from the contact to the centre
  const std::array<double, 4> dyad{
      share * branch.force[0] * branch.toward[0], share * branch.force[0] * branch.toward[1],
      share * branch.force[1] * branch.toward[0], share * branch.force[1] * branch.toward[1]};
  for (double piece = 0; piece < pieces; ++piece)
    for (double offset : {-gauss_offset, gauss_offset}) {
      const double t = (piece + 0.5 + offset) / pieces;
      canvas.each_image(cell, branch.at[0] + t * branch.toward[0], branch.at[1] + t * branch.toward[1],
                        [&](double, double, double x, double z) {
                          canvas.each_node(
                              x, z, [&](MapNode& node, double phi) { add_times(phi, dyad, node.branch); });
                        });
    }
  const double n_x = branch.toward[0] / length, n_z = branch.toward[1] / length;
  const double wall = branch.at_wall ? 1 : 0;
  const std::array<double, 7> end{branch.force[0],        branch.force[1], wall * branch.force[0],
                                  wall * branch.force[1], n_x * n_x / 2,   n_x * n_z / 2,
                                  n_z * n_z / 2};
  canvas.each_image(cell, branch.at[0] + branch.toward[0], branch.at[1] + branch.toward[1],
                    [&](double, double, double x, double z) {
                      canvas.each_node(x, z,
                                       [&](MapNode& node, double phi) { add_times(phi, end, node.contact); });
                    });
}

struct GrainState {
  double x, z, area, mass, contacts, spin;
  double v_x, v_z;  ///< relative to the drum
  double u_x, u_z;  ///< laboratory, instantaneous
  double force_x, force_z;
};

void add_image(const GrainState& g, Canvas& canvas) {
  const std::array<double, 5> moments{g.mass, g.mass * g.v_x, g.mass * g.v_z, g.mass * g.u_x, g.mass * g.u_z};
  const double flux_xx = moments[3] * g.u_x, flux_xz = moments[3] * g.u_z, flux_zz = moments[4] * g.u_z;
  const MapNode::Grains values{1,          g.contacts, g.spin,     moments[0], moments[1],
                               moments[2], moments[3], moments[4], flux_xx,    flux_xz,
                               flux_zz,    g.force_x,  g.force_z,  g.area};
  canvas.each_node_with_slope(g.x, g.z, [&](MapNode& node, double phi, double phi_x, double phi_z) {
    add_times(phi, values, node.grain);
    add_times(phi_x, moments, node.slope_x);
    add_times(phi_z, moments, node.slope_z);
    node.flux_divergence[0] += phi_x * flux_xx + phi_z * flux_xz;
    node.flux_divergence[1] += phi_x * flux_xz + phi_z * flux_zz;
  });
}

/// A grain and its images, which a moving cell makes faster.
void add_grain(const GrainState& g, const std::optional<FlowCell>& cell, Canvas& canvas) {
  canvas.each_image(cell, g.x, g.z, [&](double columns, double rows, double x, double z) {
    GrainState image = g;
    image.x = x, image.z = z;
    if (cell) {
      const double v_x = rows * cell->v_x + columns * cell->right_v_x, v_z = rows * cell->v_z;
      image.v_x += v_x, image.u_x += v_x, image.v_z += v_z, image.u_z += v_z;
    }
    add_image(image, canvas);
  });
}

}  // namespace

CoarseGraining coarse_graining(const FlowFrame& frame, double x_from, double x_to, double z_from, double z_to,
                               double spacing, double width, double period, bool closed) {
  if (!(spacing > 0) || !(width >= spacing) || width > most_spacings_per_width * spacing)
    throw InputError("a map of spacing " + std::to_string(spacing) + " d with a kernel of width " +
                     std::to_string(width) + " d: the width must be 1 to " +
                     std::to_string(static_cast<int>(most_spacings_per_width)) + " spacings");
  CoarseGraining graining{frame, {}, width, period};
  MapGrid& grid = graining.grid;
  grid.spacing_z = grid.spacing_x = spacing;
  const double first_row = std::floor(z_from / spacing), end_row = std::ceil(z_to / spacing);
  grid.z_first = (first_row + 0.5) * spacing;
  grid.rows = static_cast<std::size_t>(std::max(1.0, end_row - first_row));
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
  } else {
    const double first = std::floor(x_from / spacing), last = std::ceil(x_to / spacing);
    grid.x_first = first * spacing;
    grid.columns = static_cast<std::size_t>(last - first) + 1;
  }
  return graining;
}

MapSums empty_sums(const CoarseGraining& graining) { return {NodeTiles<MapNode>(graining.grid), {}}; }

void add_snapshot(const CoarseGraining& graining, const Snapshot& snapshot, const FlowSnapshot& in_frame,
                  MapSums& sums) {
  Canvas canvas(graining, sums.nodes);
  const FlowFrame& frame = graining.frame;
  const Period period = period_of(snapshot);
  std::vector<double> force_x(in_frame.x.size()), force_z(in_frame.x.size());  // of all contacts, per grain
  for (const HalfBranch<2>& branch : in_frame.half_branches()) {
    force_x[branch.grain] += branch.force[0];
    force_z[branch.grain] += branch.force[1];
    add_half_branch(branch, graining.width, in_frame.cell, canvas);
  }
  for (std::size_t i = 0; i < in_frame.x.size(); ++i) {
    const double radius = in_frame.radius[i], area = std::numbers::pi * radius * radius;
    Point velocity{snapshot.v_x[i], snapshot.v_z[i]};
    if (snapshot.cell) velocity = first_image(period, grain_of(snapshot, i)).velocity;
    add_grain({in_frame.x[i], in_frame.z[i], area, in_frame.density_of(i) * area,
               static_cast<double>(in_frame.coordination[i]), in_frame.spin.empty() ? 0 : in_frame.spin[i],
               in_frame.v_x[i], in_frame.v_z[i], frame.along(velocity.x, velocity.z),
               frame.normal(velocity.x, velocity.z), force_x[i], force_z[i]},
              in_frame.cell, canvas);
  }
  MapSums::Snapshots& known = sums.snapshots;
  known.count += 1;
  known.gravity_x += frame.along(snapshot.gravity_x, snapshot.gravity_z);
  known.gravity_z += frame.normal(snapshot.gravity_x, snapshot.gravity_z);
  known.spin += in_frame.spin.empty() ? 0 : 1;
  known.contacts += in_frame.contacts_known ? 1 : 0;
  known.densities += in_frame.density.empty() ? 0 : 1;
}

}  // namespace drumlin::particles
