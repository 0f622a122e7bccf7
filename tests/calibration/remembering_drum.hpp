#pragma once
// A drum as a map of tensors whose stress remembers by a law that is known.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "coupling/calibration/axis_memory.hpp"

namespace drumlin::testing {

struct RememberingDrum {
  double radius = 50, axis_depth = 4, rotation = 0.012;
  double surface_speed = 1.5, decay = 5,
         half_chord = 52;  ///< v_x = speed exp(z/decay) (1 - (x/half_chord)^2)
  double noise = 0;        ///< of each component of s/p
  unsigned seed = 1;
};

inline double known_amount(double I) { return 0.31 + 0.011 * std::log(I); }

inline const coupling::AxisMemory known_memory{.c = 6, .m = 0.9, .chi = 0.6, .I_low = 1e-2, .I_high = 1e-1};

/// Steps of simple shear, where W = |D|.
inline coupling::StressPath steady_shear(std::size_t steps, double strain, double ln_I) {
  coupling::StressPath path;
  path.axis = coupling::Deviator(0, 1);
  path.ln_I = ln_I;
  path.spin_share = 1;
  path.steps.assign(steps, {strain, strain, path.axis, ln_I});
  return path;
}

/// Motion and an isotropic pressure; incompressible.
inline FieldMap moving_drum(const RememberingDrum& drum) {
  FieldMap map;
  const auto half = static_cast<std::size_t>(drum.radius);
  map.grid = {-drum.radius, drum.axis_depth - drum.radius + 0.5, 1, 1, 2 * half + 1, half};
  map.header.drum_radius = drum.radius;
  map.header.axis_depth = drum.axis_depth;
  map.header.rotation = drum.rotation;
  for (const char* name : {"nu", "v_x", "v_z", "sigma_xx", "sigma_zz", "sigma_xz", "sigma_zx", "d_v_x_dx",
                           "d_v_x_dz", "d_v_z_dx", "d_v_z_dz"})
    map.fields.push_back({name, {}, {}});
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
    const double x = map.grid.x_of(node % map.grid.columns), z = map.grid.z_of(node / map.grid.columns);
    const double L = drum.half_chord, rise = drum.surface_speed * std::exp(z / drum.decay);
    const double across = 1 - x * x / (L * L), p = 0.8 * (2 - z);
    const double stretch = -2 * x / (L * L) * rise;
    const bool inside = z <= 0 && std::hypot(x, z - drum.axis_depth) <= drum.radius;
    const double values[] = {inside ? 0.8 : 0.0,
                             rise * across,
                             -drum.decay * stretch,
                             p,
                             p,
                             0,
                             0,
                             stretch,
                             rise * across / drum.decay,
                             2 * drum.decay / (L * L) * rise,
                             -stretch};
    for (std::size_t f = 0; f < map.fields.size(); ++f) map.fields[f].value.push_back(values[f]);
  }
  return map;
}

/// The same with the stress that the law gives along the drum's own paths.
inline FieldMap remembering_drum(const RememberingDrum& drum,
                                 const coupling::AxisMemory& law = known_memory) {
  FieldMap map = moving_drum(drum);
  const coupling::PathFields fields(map, {.smoothing = 0.3, .wall_margin = 1, .surface_clearance = 0});
  std::mt19937 random(drum.seed);
  std::normal_distribution<double> normal(0, drum.noise > 0 ? drum.noise : 1);
  const auto noise = [&] { return drum.noise > 0 ? normal(random) : 0; };
  coupling::PathOptions everywhere{.surface_margin = 0, .wall_margin = 1, .I_min = 1e-9, .stride = 1};
  for (const coupling::StressPath& path : coupling::stress_paths(fields, everywhere)) {
    const auto column = static_cast<std::size_t>(std::lround(path.x - map.grid.x_first));
    const auto row = static_cast<std::size_t>(std::lround(path.z - map.grid.z_first));
    const std::size_t node = row * map.grid.columns + column;
    const double p = map.field("sigma_xx").value[node];
    const coupling::Deviator s = p * known_amount(std::exp(path.ln_I)) * coupling::carried_axes(path, law) +
                                 p * coupling::Deviator(noise(), noise());
    for (MapField& field : map.fields) {
      if (field.name == "sigma_xx") field.value[node] = p - s.real();
      if (field.name == "sigma_zz") field.value[node] = p + s.real();
      if (field.name == "sigma_xz" || field.name == "sigma_zx") field.value[node] = s.imag();
    }
  }
  return map;
}

}  // namespace drumlin::testing
