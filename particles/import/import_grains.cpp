#include "particles/import/import_grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::particles {

Rows rows_of(const FrameTable& table, const ImportDescription& description) {
  Rows rows;
  if (table.has("id")) {
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const double id = table.columns.at("id").values[row];
      if (id != std::floor(id) || !(id >= 0 && id < 1e15))
        table.refuse(row, "id", fmt::format("{} is no id", id), "a whole number >= 0");
      rows.id.push_back(static_cast<std::int64_t>(id));
    }
  } else {
    rows.id.resize(table.rows());
    std::iota(rows.id.begin(), rows.id.end(), 0);
  }
  const auto* lammps = std::get_if<LammpsSource>(&description.source);
  const bool has_walls = lammps && !lammps->wall_types.empty();
  const std::vector<double> type = has_walls ? table.values("type", {1, 1, 1}) : std::vector<double>();
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const bool wall = has_walls && std::find(lammps->wall_types.begin(), lammps->wall_types.end(),
                                             type[row]) != lammps->wall_types.end();
    (wall ? rows.wall_atoms : rows.grains).push_back(row);
  }
  std::sort(rows.grains.begin(), rows.grains.end(),
            [&](std::size_t a, std::size_t b) { return rows.id[a] < rows.id[b]; });
  for (std::size_t g = 1; g < rows.grains.size(); ++g)
    if (rows.id[rows.grains[g]] == rows.id[rows.grains[g - 1]])
      table.refuse(std::max(rows.grains[g], rows.grains[g - 1]), table.word("id"),
                   fmt::format("{} appears twice in one snapshot", rows.id[rows.grains[g]]));
  if (rows.grains.empty()) table.refuse(0, "", "there are no grains");
  return rows;
}

Scales scales_for(const ImportDescription& description, const FrameTable& table, const Rows& rows) {
  double diameter_m = description.grains.mean_diameter_m.value_or(0);
  if (!description.grains.mean_diameter_m) {
    const std::vector<double> radius = table.values("radius", {1, 1, 1});
    if (!table.columns.at("radius").in_si)
      throw InputError("grains.mean_diameter_m: is needed, for the radii of " + table.file + " have no unit");
    for (const std::size_t row : rows.grains)
      diameter_m += 2 * radius[row] / static_cast<double>(rows.grains.size());
    if (!(diameter_m > 0)) table.refuse(0, "radius", "the mean radius is not above 0");
  }
  return drumlin::scales_of(diameter_m, description.gravity.acceleration_m_s2,
                            description.grains.density_kg_m3);
}

Snapshot frame_of(const ImportDescription& description, const Scales& scales) {
  Snapshot s;
  s.scales = scales;
  s.time_step = description.time_step_s.value_or(scales.time_s) / scales.time_s;
  const double direction = description.gravity.direction_deg * std::numbers::pi / 180;
  s.gravity_x = std::cos(direction);
  s.gravity_z = std::sin(direction);
  if (description.drum) {
    s.container_x = description.drum->center_m[0] / scales.length_m;
    s.container_z = description.drum->center_m[1] / scales.length_m;
    s.container_radius = description.drum->radius_m / scales.length_m;
    s.wall_spin = description.drum->speed_rpm * 2 * std::numbers::pi / 60 * scales.time_s;
  }
  if (description.periodic_x) s.period_x = description.periodic_x->length_m / scales.length_m;
  return s;
}

namespace {

void check_flat(const FrameTable& table, const Snapshot& s, const Rows& rows) {
  if (!table.has("third")) return;
  const std::vector<double> third = table.values("third", s.scales);
  for (const std::size_t row : rows.grains)
    if (std::abs(third[row] - third[rows.grains.front()]) > s.radius.front())
      table.refuse(row, "", "the grains lie in space, not in a plane", "one layer of grains");
}

/// Two grains in one place are one that is written twice, or a column that is not what it says.
void check_apart(const FrameTable& table, const Snapshot& s, const Rows& rows) {
  constexpr double one_place = 1e-9;  // d
  std::vector<std::size_t> order(s.x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return s.x[a] < s.x[b]; });
  for (std::size_t k = 0; k < order.size(); ++k)
    for (std::size_t l = k + 1; l < order.size() && s.x[order[l]] - s.x[order[k]] <= one_place; ++l) {
      const std::size_t a = std::min(order[k], order[l]), b = std::max(order[k], order[l]);
      if (std::abs(s.z[a] - s.z[b]) <= one_place)
        table.refuse(rows.grains[b], table.word("x") + ", " + table.word("z"),
                     fmt::format("grains {} and {} are in one place", rows.id[rows.grains[a]],
                                 rows.id[rows.grains[b]]),
                     "a place for each grain");
    }
}

}  // namespace

void add_velocities(const FrameTable& table, const Rows& rows, Snapshot& s) {
  for (const auto& [name, target] : {std::pair{"v_x", &s.v_x}, std::pair{"v_z", &s.v_z}}) {
    if (!table.has(name))
      table.refuse(table.rows(), table.word(name), "no such column",
                   "one, or grains.velocities = \"displacements\" in the description");
    const std::vector<double> values = table.values(name, s.scales);
    for (const std::size_t row : rows.grains) target->push_back(values[row]);
  }
}

void add_displacements(const Snapshot& before, Snapshot& s) {
  s.velocity_window = s.time - before.time;
  for (std::size_t g = 0; g < s.x.size(); ++g) {
    double d_x = s.x[g] - before.x[g];
    if (s.period_x > 0) d_x -= s.period_x * std::round(d_x / s.period_x);
    s.displacement_x.push_back(d_x), s.displacement_z.push_back(s.z[g] - before.z[g]);
    s.v_x.push_back(d_x / s.velocity_window), s.v_z.push_back(s.displacement_z[g] / s.velocity_window);
  }
}

void add_grains(const FrameTable& table, const Rows& rows, Snapshot& s) {
  constexpr double same = 1e-6;  // relative: of the digits that a user writes
  const double period_m = s.period_x * s.scales.length_m;
  if (period_m > 0 && table.period_m && !(std::abs(*table.period_m / period_m - 1) <= same))
    table.refuse(table.rows(), "BOX BOUNDS", fmt::format("are periodic over {:g} m along x", *table.period_m),
                 fmt::format("{:g} m, periodic_x.length_m of the description", period_m));
  const auto add = [&](const char* name, std::vector<double>& target, double sign = 1) {
    const std::vector<double> values = table.values(name, s.scales);
    for (const std::size_t row : rows.grains) target.push_back(sign * values[row]);
  };
  add("x", s.x), add("z", s.z), add("radius", s.radius);
  if (table.has("spin_clockwise")) {
    add("spin_clockwise", s.spin);
  } else if (table.has("spin_anticlockwise")) {
    add("spin_anticlockwise", s.spin, -1);
  }
  for (std::size_t g = 0; g < s.x.size(); ++g) {
    const std::size_t row = rows.grains[g];
    if (!(s.radius[g] > 0)) table.refuse(row, table.word("radius"), "is not above 0", "> 0");
    if (s.container_radius > 0 &&
        std::hypot(s.x[g] - s.container_x, s.z[g] - s.container_z) > s.container_radius)
      table.refuse(row, table.word("x") + ", " + table.word("z"), "the grain lies outside of the drum",
                   "centre, radius and units that fit the drum");
  }
  check_flat(table, s, rows);
  check_apart(table, s, rows);
}

FrameBodies bodies_of(const FrameTable& table, const Rows& rows, const Scales& scales) {
  FrameBodies bodies;
  for (std::size_t g = 0; g < rows.grains.size(); ++g)
    bodies.grain[rows.id[rows.grains[g]]] = static_cast<std::int32_t>(g);
  const std::vector<double> x = table.values("x", scales), z = table.values("z", scales);
  for (const std::size_t row : rows.wall_atoms) bodies.wall_atoms[rows.id[row]] = {x[row], z[row]};
  return bodies;
}

}  // namespace drumlin::particles
