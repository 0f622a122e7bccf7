#include "particles/io/run_grids.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

#include "particles/bodies/arc.hpp"

namespace drumlin::particles {
namespace {

using Numbers = std::vector<double>;

constexpr int circle_pieces = 360;  // of a container; those of a disc are fewer but look as round

/// The plane of the grains is that of ParaView's first look: (x, z) of the project lies at (x, y) of VTK.
void add_point(std::vector<float>& points, double x, double z) {
  points.insert(points.end(), {static_cast<float>(x), static_cast<float>(z), 0.0f});
}

VtuArray scalar(const std::string& name, const Numbers& values, double unit) {
  std::vector<float> scaled;
  for (const double value : values) scaled.push_back(static_cast<float>(value * unit));
  return {name, 1, std::move(scaled)};
}

VtuArray vector(const std::string& name, const Numbers& x, const Numbers& z, double unit) {
  std::vector<float> scaled;
  for (std::size_t i = 0; i < x.size(); ++i) add_point(scaled, x[i] * unit, z[i] * unit);
  return {name, 3, std::move(scaled)};
}

/// Places as they are shown: in a periodic domain, or a cell, brought back into it.
struct ShownPlaces {
  Numbers x, z;
};
ShownPlaces shown_places(const RunFolder& run, const Snapshot& s) {
  if (!run.scene.periodic_x) return {s.x, s.z};
  Period period{run.scene.periodic_x->x_min_mm * 1e-3 / run.scales.length_m, s.period_x};
  if (s.cell) period = {s.cell->x, s.period_x, s.cell->z, s.cell->height, s.cell->offset};
  ShownPlaces places;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const Point first = period.first(Point{s.x[i], s.z[i]});
    places.x.push_back(first.x), places.z.push_back(first.z);
  }
  return places;
}

}  // namespace

VtuGrid grain_grid(const RunFolder& run, const Snapshot& s) {
  const double metre = s.scales.length_m, second = s.scales.time_s;
  VtuGrid grid;
  const auto [x, z] = shown_places(run, s);
  std::vector<std::int32_t> number;
  for (std::size_t i = 0; i < x.size(); ++i) {
    add_point(grid.points, x[i] * metre, z[i] * metre);
    number.push_back(static_cast<std::int32_t>(i));
    grid.offsets.push_back(static_cast<std::int32_t>(i + 1));
  }
  grid.connectivity = number;
  grid.point_data = {scalar("radius_m", s.radius, metre),
                     vector("velocity_m_s", s.v_x, s.v_z, metre / second)};
  if (!s.spin.empty()) grid.point_data.push_back(scalar("spin_clockwise_rad_s", s.spin, 1 / second));
  if (!s.displacement_x.empty())
    grid.point_data.push_back(vector("displacement_m", s.displacement_x, s.displacement_z, metre));
  grid.point_data.push_back({"grain", 1, std::move(number)});
  return grid;
}

VtuGrid contact_grid(const RunFolder& run, const Snapshot& s) {
  const double metre = s.scales.length_m, second = s.scales.time_s;
  const double impulse_unit = s.scales.density_kg_m3 * metre * metre * metre / second;  // per metre of depth
  VtuGrid grid;
  grid.cell = VtuCell::line;
  const auto [x, z] = shown_places(run, s);
  Numbers n, t;
  std::vector<std::int32_t> i, j;
  for (const SnapshotContact& c : s.contacts) {
    // Against the normal: right across the seam of a periodic domain, too.
    const double reach = s.radius[c.i] + (c.j < 0 ? 0 : s.radius[c.j]);
    add_point(grid.points, x[c.i] * metre, z[c.i] * metre);
    add_point(grid.points, (x[c.i] - reach * c.normal_x) * metre, (z[c.i] - reach * c.normal_z) * metre);
    const auto end = static_cast<std::int32_t>(grid.points.size() / 3);
    grid.connectivity.insert(grid.connectivity.end(), {end - 2, end - 1});
    grid.offsets.push_back(end);
    n.push_back(c.impulse_n), t.push_back(c.impulse_t);
    i.push_back(c.i), j.push_back(c.j);
  }
  const double force_unit = impulse_unit / (s.time_step * second);
  grid.cell_data = {scalar("normal_impulse_N_s_m", n, impulse_unit),
                    scalar("tangential_impulse_N_s_m", t, impulse_unit),
                    scalar("normal_force_N_m", n, force_unit),
                    scalar("tangential_force_N_m", t, force_unit),
                    {"grain_i", 1, std::move(i)},
                    {"grain_or_wall_j", 1, std::move(j)}};
  return grid;
}

VtuGrid wall_grid(const RunFolder& run, const Snapshot& s) {
  const double metre = s.scales.length_m;
  VtuGrid grid;
  grid.cell = VtuCell::line;  // meshio knows no lines of more than two points
  std::vector<std::int32_t> shape_numbers;
  std::int32_t shape = 0;
  for (const PlacedShape& placed : shapes_at(run, s)) {
    const std::size_t first = grid.points.size() / 3;
    const auto circle = [&](const Point& center, double radius, int pieces) {
      for (int k = 0; k <= pieces; ++k) {
        const double angle = 2 * std::numbers::pi * k / pieces - placed.angle;
        add_point(grid.points, (center.x + radius * std::cos(angle)) * metre,
                  (center.z + radius * std::sin(angle)) * metre);
      }
    };
    if (const auto* container = std::get_if<Container>(&placed.shape)) {
      circle(container->center, container->radius, circle_pieces);
    } else if (const auto* segment = std::get_if<Segment>(&placed.shape)) {
      for (const Point& end : {segment->from, segment->to})
        add_point(grid.points, end.x * metre, end.z * metre);
    } else if (const auto* arc = std::get_if<Arc>(&placed.shape)) {
      for (const Point& p : points_of(*arc, circle_pieces / 2))
        add_point(grid.points, p.x * metre, p.z * metre);
    } else if (!is_open(placed.shape)) {
      const auto& disc = std::get<FixedDisc>(placed.shape);
      circle(disc.center, disc.radius, circle_pieces / 10);
    }
    --shape;  // also that of an opened one, which has no cells: as in grain_or_wall_j of the contacts
    for (std::size_t p = first + 1; p < grid.points.size() / 3; ++p) {
      const auto end = static_cast<std::int32_t>(p);
      grid.connectivity.insert(grid.connectivity.end(), {end - 1, end});
      grid.offsets.push_back(static_cast<std::int32_t>(grid.connectivity.size()));
      shape_numbers.push_back(shape);
    }
  }
  grid.cell_data = {{"wall", 1, std::move(shape_numbers)}};
  return grid;
}

}  // namespace drumlin::particles
