#pragma once
// Plane shear in closed form: a packing of particles that is loose at both walls, and the continuum beside
// it.
#include <cmath>

#include "coupling/comparison/comparison.hpp"
#include "tests/support/headers.hpp"

namespace drumlin::testing {

inline constexpr double shear_example_rate = 0.1, shear_example_pressure = 4;

/// v_x = rate (z - base), nu as given, and the stresses of mu = 0.3.
inline ProfileSet sheared_layers(std::vector<double> z, double base, std::vector<double> nu) {
  ProfileSet set;
  const std::size_t layers = z.size();
  const auto constant = [&](const char* name, double value) {
    set.columns.push_back({name, std::vector<double>(layers, value), {}});
  };
  std::vector<double> speed;
  for (const double place : z) speed.push_back(shear_example_rate * (place - base));
  set.columns.push_back({"v_x", std::move(speed), {}});
  constant("shear_rate", shear_example_rate);
  constant("sigma_xx", shear_example_pressure);
  constant("sigma_zz", shear_example_pressure);
  constant("sigma_xz", 0.3 * shear_example_pressure);
  constant("mu", 0.3);
  constant("k", 1);
  constant("I", shear_example_rate / std::sqrt(shear_example_pressure));
  set.columns.push_back({"nu", std::move(nu), {}});
  set.z = std::move(z);
  return set;
}

inline RunHeader sheared_header(const char* side, double wall) {
  RunHeader header = header_from({{"rotation", "0"},
                                  {"drum_radius", "0"},
                                  {"diameter_m", "0.002"},
                                  {"reduced", "true"},
                                  {"side", side},
                                  {"theta_deg", "0"},
                                  {"geometry", "plane_shear"},
                                  {"position", "0"},
                                  {"layer_thickness", "1"}});
  header.wall_z = wall;
  return header;
}

/// 22 layers from -21 to 1, the lowest half as dense as the others, the highest a quarter: 20.75 d of a dense
/// packing, from -20.5 to 0.25.
inline ProfileSet sheared_packing() {
  std::vector<double> z, nu(22, 0.8);
  for (int l = 0; l < 22; ++l) z.push_back(-20.5 + l);
  nu.front() = 0.4, nu.back() = 0.2;
  ProfileSet set = sheared_layers(std::move(z), -20.5, std::move(nu));
  set.header = sheared_header("particles", -21);
  return set;
}

/// The same flow between walls at -20.75 and 0.
inline ProfileSet sheared_continuum() {
  std::vector<double> z;
  for (int l = 20; l >= 0; --l) z.push_back(l < 20 ? -0.5 - l : -20.375);
  ProfileSet set = sheared_layers(z, -20.75, std::vector<double>(21, 0.8));
  set.header = sheared_header("continuum", -20.75);
  return set;
}

inline coupling::ComparedSide shear_side(ProfileSet profiles) { return {std::move(profiles), {}, {}}; }

}  // namespace drumlin::testing
