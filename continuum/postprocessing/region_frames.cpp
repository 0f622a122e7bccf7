#include "continuum/postprocessing/region_frames.hpp"

#include <algorithm>
#include <cmath>

#include "continuum/model/region_mesh.hpp"

namespace drumlin::continuum {
namespace {

constexpr unsigned int points_per_side = 5;  // per cell: closer together than a kernel's width

// Adds the area of the outline in each column over the column's width.
void add_column_heights(const MapGrid& grid, const Outline& outline, std::vector<double>& heights) {
  const std::size_t n = outline.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 a = outline.points[i], b = outline.points[(i + 1) % n];
    const double low = std::min(a.x, b.x), high = std::max(a.x, b.x), sign = a.x < b.x ? -1 : 1;
    if (low == high) continue;
    const auto z_at = [&](double x) { return a.z + (b.z - a.z) * (x - a.x) / (b.x - a.x); };
    const auto column_of = [&](double x) {
      return std::clamp(std::floor((x - grid.x_first) / grid.spacing_x + 0.5), 0.0,
                        static_cast<double>(grid.columns - 1));
    };
    for (double c = column_of(low); c <= column_of(high); ++c) {
      const double middle = grid.x_first + c * grid.spacing_x;
      const double from = std::max(low, middle - 0.5 * grid.spacing_x),
                   to = std::min(high, middle + 0.5 * grid.spacing_x);
      if (from < to)
        heights[static_cast<std::size_t>(c)] +=
            sign * 0.5 * (z_at(from) + z_at(to)) * (to - from) / grid.spacing_x;
    }
  }
}

}  // namespace

Frame region_frame(const FrameRequest& request, const Region& region, const RegionState& state,
                   const RegionStep& step, const FlowField& field) {
  SmoothedFlow smoothed(request.grid, request.kernel_width);
  double area = 0, kinetic = 0;
  Vec2 center;
  for (const FlowPiece& piece : field.pieces(points_per_side)) {
    const PointState& s = piece.state;
    smoothed.add(
        {piece.place.x,
         piece.place.z,
         piece.area,
         {request.nu, s.velocity.x, s.velocity.z, {}, {s.sigma_xx, -s.sigma_xz, -s.sigma_xz, s.sigma_zz}}});
    area += piece.area;
    center.x += piece.place.x * piece.area;
    center.z += piece.place.z * piece.area;
    kinetic += 0.5 * request.nu * (s.velocity.x * s.velocity.x + s.velocity.z * s.velocity.z) * piece.area;
  }
  Frame frame = smoothed.frame(request.nu);
  frame.mass_height.assign(request.grid.columns, 0.0);
  for (const Outline& outline : outlines_of(state.mesh))
    add_column_heights(request.grid, outline, frame.mass_height);
  frame.scalars = {{"area", area},
                   {"centre_x", center.x / area},
                   {"centre_z", center.z / area},
                   {"kinetic_energy", kinetic},
                   {"discharged", state.discharged},
                   {"discharge_rate", step.discharge_rate}};
  for (std::size_t i = 0; i < region.parts.size(); ++i) {
    if (region.parts[i].kind == RegionPart::Kind::opening) continue;
    auto& load = frame.loads[region.parts[i].name];
    if (i < step.loads.size()) load = {load[0] + step.loads[i].x, load[1] + step.loads[i].z};
  }
  return frame;
}

}  // namespace drumlin::continuum
