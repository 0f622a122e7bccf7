#include "continuum/sampling/flow_maps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "coupling/exchange/text_file.hpp"

namespace drumlin {
namespace {

std::vector<Vec2> grid_points(const MapArea& area, double spacing) {
  // A hair inside: a last row that falls on the edge by rounding is none to lose.
  const auto first = [&](double low) { return static_cast<int>(std::ceil(low / spacing - 1e-9)); };
  const auto last = [&](double high) { return static_cast<int>(std::floor(high / spacing + 1e-9)); };
  std::vector<Vec2> points;
  for (int row = last(area.z_max); row >= first(area.z_min); --row)
    for (int column = first(area.x_min); column <= last(area.x_max); ++column)
      if (const Vec2 p{column * spacing, row * spacing}; area.inside(p)) points.push_back(p);
  return points;
}

}  // namespace

void write_maps(const std::filesystem::path& file, const FlowField& field, const MapArea& area,
                double spacing, bool reduced) {
  const auto points = grid_points(area, spacing);
  const auto states = field.at(points);
  if (!field.on_first_rank()) return;
  std::string text = fmt::format("# drumlin-flow-maps-1\n# reduced = {}\n# spacing = {}\n", reduced, spacing);
  for (const auto& [key, value] : area.header) text += fmt::format("# {} = {}\n", key, value);
  text += "x,z,v_x,v_z,pressure,sigma_xx,sigma_zz,sigma_xz,I,mu,viscosity,well_posedness_margin\n";
  for (std::size_t k = 0; k < points.size(); ++k) {
    const PointState& s = states[k];
    if (!std::isfinite(s.pressure)) continue;
    const Vec2 v = area.seen ? area.seen(points[k], s.velocity) : s.velocity;
    fmt::format_to(std::back_inserter(text),
                   "{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n",
                   points[k].x, points[k].z, v.x, v.z, s.pressure, s.sigma_xx, s.sigma_zz, s.sigma_xz,
                   2 * s.rate / std::sqrt(s.law_pressure), s.shear_stress / s.law_pressure, s.viscosity,
                   s.well_posedness);
  }
  replace_file(file, text);
}

}  // namespace drumlin
