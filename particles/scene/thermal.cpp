#include "particles/scene/thermal.hpp"

#include <cmath>
#include <numbers>

#include "particles/scene/random.hpp"

namespace drumlin::particles {

void add_thermal_motion(double speed, std::uint64_t seed, Bodies& bodies) {
  RandomStream random(seed, "thermal motion");
  const std::size_t count = bodies.count();
  std::vector<double> x(count), z(count);
  double mass = 0, momentum_x = 0, momentum_z = 0;
  for (std::size_t b = 0; b < count; ++b) {
    // Box and Muller: two normal numbers from two uniform ones.
    const double length = std::sqrt(-2 * std::log(1 - random.uniform()) * bodies.inverse_mass[b]);
    const double angle = 2 * std::numbers::pi * random.uniform();
    x[b] = length * std::cos(angle), z[b] = length * std::sin(angle);
    const double m = 1 / bodies.inverse_mass[b];
    mass += m, momentum_x += m * x[b], momentum_z += m * z[b];
  }
  double energy = 0;
  for (std::size_t b = 0; b < count; ++b) {
    x[b] -= momentum_x / mass, z[b] -= momentum_z / mass;
    energy += (x[b] * x[b] + z[b] * z[b]) / bodies.inverse_mass[b];
  }
  if (!(energy > 0) || count < 2) return;
  const double scale = speed * std::sqrt(mass / energy);
  for (std::size_t b = 0; b < count; ++b) bodies.v_x[b] += scale * x[b], bodies.v_z[b] += scale * z[b];
}

}  // namespace drumlin::particles
