#include "continuum/postprocessing/flow_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "coupling/core/basics/inertial_number.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/plane_invariants.hpp"

namespace drumlin::continuum {
namespace {

constexpr std::array names = {"nu",
                              "v_x",
                              "v_z",
                              "d_v_x_dx",
                              "d_v_x_dz",
                              "d_v_z_dx",
                              "d_v_z_dz",
                              "D_xx",
                              "D_zz",
                              "D_xz",
                              "strain_rate",
                              "half_vorticity",
                              "sigma_xx",
                              "sigma_zz",
                              "sigma_xz",
                              "sigma_zx",
                              "p",
                              "tau",
                              "I",
                              "mu",
                              "k",
                              "axis_angle_deg",
                              "I_law",
                              "mu_law",
                              "k_law",
                              "viscosity",
                              "well_posedness_margin"};
using Values = std::array<double, names.size()>;

Values values_at(const PointState& s, Vec2 point, const MapArea& area) {
  Vec2 v = s.velocity;
  PlaneMatrix gradient{s.dvx_dx, s.dvx_dz, s.dvz_dx, s.dvz_dz};
  if (area.frame) {
    const Vec2 rigid = rigid_rotation(area.frame->rotation, area.frame->axis_offset, point);
    v = {v.x - rigid.x, v.z - rigid.z};
    gradient.xz -= area.frame->rotation;
    gradient.zx += area.frame->rotation;
  }
  const PlaneInvariants at = plane_invariants({s.sigma_xx, -s.sigma_xz, -s.sigma_xz, s.sigma_zz}, gradient);
  return {area.nu,
          v.x,
          v.z,
          gradient.xx,
          gradient.xz,
          gradient.zx,
          gradient.zz,
          gradient.xx,
          gradient.zz,
          (gradient.xz + gradient.zx) / 2,
          at.strain_rate,
          at.half_vorticity,
          s.sigma_xx,
          s.sigma_zz,
          s.sigma_xz,
          s.sigma_xz,
          at.p,
          at.tau,
          at.I,
          at.mu,
          at.k,
          at.axis_angle_deg,
          inertial_number(2 * s.rate, s.law_pressure),
          s.shear_stress / s.law_pressure,
          s.k,
          s.viscosity,
          s.well_posedness};
}

// A hair inside: a last row that falls on the edge by rounding is none to lose.
double first_node(double low, double spacing) { return std::ceil(low / spacing - 1e-9) * spacing; }
std::size_t nodes_between(double low, double high, double spacing) {
  return static_cast<std::size_t>(
      std::max(0.0, std::floor(high / spacing + 1e-9) - std::ceil(low / spacing - 1e-9) + 1));
}

MapGrid grid_of(const MapArea& area, double spacing) {
  return {.x_first = first_node(area.x_min, spacing),
          .z_first = first_node(area.z_min, spacing),
          .spacing_x = spacing,
          .spacing_z = spacing,
          .columns = nodes_between(area.x_min, area.x_max, spacing),
          .rows = nodes_between(area.z_min, area.z_max, spacing)};
}

}  // namespace

FieldMap flow_map(const FlowField& field, const MapArea& area, double spacing) {
  FieldMap map;
  map.grid = grid_of(area, spacing);
  map.header = area.header;
  for (const char* name : names)
    map.fields.push_back({name, std::vector<double>(map.grid.nodes(), no_value), {}});
  constexpr std::array of_memory = {"memory_xx", "memory_xz", "memory_rho"};
  if (field.remembers())
    for (const char* name : of_memory)
      map.fields.push_back({name, std::vector<double>(map.grid.nodes(), no_value), {}});
  if (field.has_fluidity())
    map.fields.push_back({"fluidity", std::vector<double>(map.grid.nodes(), no_value), {}});
  std::vector<std::size_t> nodes;
  std::vector<Vec2> points, places;  // in the map, in the domain
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
    const Vec2 point{map.grid.x_of(node % map.grid.columns), map.grid.z_of(node / map.grid.columns)};
    if (!area.inside(point)) continue;
    nodes.push_back(node);
    points.push_back(point);
    places.push_back({point.x, point.z + area.z_zero});
  }
  const auto states = field.at(places);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(states[i].pressure)) continue;  // between the domain and its quadratic cells
    const Values values = values_at(states[i], points[i], area);
    for (std::size_t f = 0; f < names.size(); ++f) map.fields[f].value[nodes[i]] = values[f];
    const std::array memory = {states[i].memory_xx, states[i].memory_xz, states[i].memory_rho};
    if (field.remembers())
      for (std::size_t f = 0; f < memory.size(); ++f)
        map.fields[names.size() + f].value[nodes[i]] = memory[f];
    if (field.has_fluidity()) map.fields.back().value[nodes[i]] = states[i].fluidity;
  }
  return map;
}

}  // namespace drumlin::continuum
