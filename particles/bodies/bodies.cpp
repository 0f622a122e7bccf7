#include "particles/bodies/bodies.hpp"

#include <numbers>

namespace drumlin::particles {

double mass_of_disc(double radius) { return std::numbers::pi * radius * radius; }

void add_body(Bodies& bodies, double x, double z, double radius) {
  bodies.x.push_back(x);
  bodies.z.push_back(z);
  bodies.v_x.push_back(0);
  bodies.v_z.push_back(0);
  bodies.radius.push_back(radius);
  bodies.inverse_mass.push_back(1 / mass_of_disc(radius));
}

double kinetic_energy(const Bodies& bodies) {
  double energy = 0;
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    double square = bodies.v_x[b] * bodies.v_x[b] + bodies.v_z[b] * bodies.v_z[b];
    if (!bodies.spin.empty()) {
      const double rim = bodies.radius[b] * bodies.spin[b];
      square += rim * rim / 2;
    }
    energy += square / (2 * bodies.inverse_mass[b]);
  }
  return energy;
}

}  // namespace drumlin::particles
