#pragma once
// The flow of example.hpp over the plane of its drum.
#include "coupling/core/results/plane_invariants.hpp"
#include "tests/comparison/example.hpp"

namespace drumlin::testing {

/// Nodes every 0.5 d inside the drum up to the surface, all fields of one depth alike along x, with intervals
/// of 1 %.
inline FieldMap example_map(const std::string& side = "particles") {
  FieldMap map;
  map.grid = {-68, -64, 0.5, 0.5, 273, 129};
  map.header = example_profiles().header;
  set_entry(map.header, "side", side);
  map.scales = {0.0033, 0.01834098, 2700};
  const char* names[] = {"nu",       "v_x",      "v_z",      "d_v_x_dx", "d_v_x_dz",       "d_v_z_dx",
                         "d_v_z_dz", "sigma_xx", "sigma_zz", "sigma_xz", "half_vorticity", "strain_rate",
                         "p",        "I",        "mu",       "k",        "axis_angle_deg"};
  for (const char* name : names) map.fields.push_back({name, {}, {}});
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
    const double x = map.grid.x_of(node % map.grid.columns), z = map.grid.z_of(node / map.grid.columns);
    const bool inside = std::hypot(x, z - 4) < 68.18;
    const double rate = example_shear_rate(z);
    const double v = z > -example_H ? example_rate * (z + example_H + example_lambda) : rate * example_lambda;
    const PlaneInvariants at = plane_invariants({-0.78 * z, 0.27 * z, 0.27 * z, -0.75 * z}, {0, rate, 0, 0});
    const double values[] = {example_nu,
                             v,
                             1e-3,
                             0,
                             rate,
                             0,
                             0,
                             -0.78 * z,
                             -0.75 * z,
                             -0.27 * z,
                             at.half_vorticity,
                             at.strain_rate,
                             at.p,
                             at.I,
                             at.mu,
                             at.k,
                             at.axis_angle_deg};
    for (std::size_t i = 0; i < map.fields.size(); ++i) {
      map.fields[i].value.push_back(inside ? values[i] : std::nan(""));
      map.fields[i].ci99.push_back(inside ? 0.01 * std::abs(values[i]) : std::nan(""));
    }
  }
  return map;
}

}  // namespace drumlin::testing
