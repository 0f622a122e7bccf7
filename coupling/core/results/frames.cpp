#include "coupling/core/results/frames.hpp"

#include <fmt/format.h>

#include <cmath>

#include "coupling/core/basics/no_value.hpp"

namespace drumlin {
namespace {

template <class Map>
std::vector<std::string> names_in(const Map& map) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

std::string fault_of(const Frame& frame, const Frame& first, const MapGrid& grid) {
  if (frame.height.size() != grid.columns || frame.mass_height.size() != grid.columns)
    return fmt::format("a height has another length than the {} columns of the grid", grid.columns);
  if (names_in(frame.fields) != names_in(first.fields) ||
      names_in(frame.scalars) != names_in(first.scalars) || names_in(frame.loads) != names_in(first.loads))
    return "two frames hold not the same fields, scalars and loads";
  return {};
}

}  // namespace

std::string fault_of(const Frames& frames) {
  if (frames.frames.empty() || frames.frames.size() != frames.runs.size() * frames.times.size())
    return fmt::format("{} frames of {} runs at {} times", frames.frames.size(), frames.runs.size(),
                       frames.times.size());
  for (const Frame& frame : frames.frames) {
    FieldMap map{frames.grid, {}, frames.header, frames.scales};
    for (const auto& [name, values] : frame.fields) map.fields.push_back({name, values, {}});
    for (const std::string& fault : {fault_of(map), fault_of(frame, frames.frames.front(), frames.grid)})
      if (!fault.empty()) return fault;
  }
  return {};
}

void set_fields(const MapGrid& grid, double nu_bulk, const std::function<NodeFlow(std::size_t)>& flow_at,
                Frame& frame) {
  constexpr std::array names{"nu", "v_x", "v_z", "sigma_xx", "sigma_zz", "sigma_xz", "I", "mu", "p"};
  std::array<std::vector<double>, names.size()> fields;
  fields.fill(std::vector<double>(grid.nodes(), no_value));
  std::vector<double> nu_everywhere(grid.nodes());
  for (std::size_t node = 0; node < grid.nodes(); ++node) {
    const auto [nu, v_x, v_z, gradient, pressure] = flow_at(node);
    nu_everywhere[node] = nu;
    if (!(nu >= least_map_nu)) continue;
    const PlaneInvariants at = plane_invariants(pressure, gradient);
    const std::array values{nu, v_x, v_z, pressure.xx, pressure.zz, -pressure.xz, at.I, at.mu, at.p};
    for (std::size_t f = 0; f < names.size(); ++f) fields[f][node] = values[f];
  }
  frame.height = surface_heights(grid, nu_everywhere, nu_bulk / 2);
  for (std::size_t f = 0; f < names.size(); ++f) frame.fields[names[f]] = std::move(fields[f]);
}

void SmoothedFlow::add(const MaterialPiece& piece) {
  const auto& [nu, v_x, v_z, gradient, P] = piece.flow;
  const double mass = nu * piece.area;
  kernel_.each_node(piece.x, piece.z, [&](MapPlace at, const KernelWeight& weight) {
    Node& node = nodes_[at.row * grid_.columns + at.column];
    node.carried.add(weight, {mass, mass * v_x, mass * v_z});
    node.pressure.xx += weight.phi * (P.xx * piece.area + mass * v_x * v_x);
    node.pressure.xz += weight.phi * (P.xz * piece.area + mass * v_x * v_z);
    node.pressure.zx += weight.phi * (P.zx * piece.area + mass * v_x * v_z);
    node.pressure.zz += weight.phi * (P.zz * piece.area + mass * v_z * v_z);
  });
}

Frame SmoothedFlow::frame(double nu_bulk) const {
  Frame frame;
  const auto flow_at = [&](std::size_t n) -> NodeFlow {
    const auto& [carried, stress] = nodes_[n];
    const double nu = carried.value[0], v_x = carried.mean(1), v_z = carried.mean(2);
    return {nu,
            v_x,
            v_z,
            {carried.slope(1, carried.slope_x), carried.slope(1, carried.slope_z),
             carried.slope(2, carried.slope_x), carried.slope(2, carried.slope_z)},
            {stress.xx - nu * v_x * v_x, stress.xz - nu * v_x * v_z, stress.zx - nu * v_x * v_z,
             stress.zz - nu * v_z * v_z}};
  };
  set_fields(grid_, nu_bulk, flow_at, frame);
  frame.mass_height.assign(grid_.columns, no_value);
  return frame;
}

}  // namespace drumlin
