#include "particles/bodies/bodies.hpp"

#include <numbers>

#include "particles/bodies/disc_inertia.hpp"

namespace drumlin::particles {

double mass_of_disc(double radius) { return std::numbers::pi * radius * radius; }

void keep_bodies(std::span<const std::uint8_t> keep, Bodies& bodies) {
  for (auto* values :
       {&bodies.x, &bodies.z, &bodies.v_x, &bodies.v_z, &bodies.spin, &bodies.radius, &bodies.inverse_mass})
    keep_entries(keep, *values);
  keep_entries(keep, bodies.material);
  keep_entries(keep, bodies.id);
}

void add_body(Bodies& bodies, double x, double z, double radius) {
  bodies.x.push_back(x);
  bodies.z.push_back(z);
  bodies.v_x.push_back(0);
  bodies.v_z.push_back(0);
  bodies.radius.push_back(radius);
  bodies.inverse_mass.push_back(1 / mass_of_disc(radius));
}

bool has_own_masses(const Bodies& bodies) {
  for (std::size_t b = 0; b < bodies.count(); ++b)
    if (bodies.inverse_mass[b] != 1 / mass_of_disc(bodies.radius[b])) return true;
  return false;
}

double kinetic_energy(const Bodies& bodies) {
  double energy = 0;
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    double square = bodies.v_x[b] * bodies.v_x[b] + bodies.v_z[b] * bodies.v_z[b];
    if (!bodies.spin.empty()) {
      const double rim = bodies.radius[b] * bodies.spin[b];
      square += disc_inertia * rim * rim;
    }
    energy += square / (2 * bodies.inverse_mass[b]);
  }
  return energy;
}

}  // namespace drumlin::particles
