#pragma once
// Grains (discs) as parallel arrays, dimensionless, in the laboratory frame.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace drumlin::particles {

/// One entry per grain. Mass and moment of inertia follow from the radius: m = pi r^2, J = m r^2 / 2 (rho0 =
/// 1, per unit depth).
struct Bodies {
  std::vector<double> x, z;  ///< in a periodic domain not wrapped back: displacements stay meaningful
  std::vector<double> v_x, v_z;
  std::vector<double> spin;  ///< empty when the scene has no spin; positive clockwise as drawn (z up)
  std::vector<double> radius;
  std::vector<double> inverse_mass;
  std::vector<std::uint8_t> material;  ///< empty when no law asks for it

  std::size_t count() const { return x.size(); }
};

/// Adds a disc at rest with the mass of its radius.
void add_body(Bodies&, double x, double z, double radius);
double mass_of_disc(double radius);
/// Kinetic energy, of the spin too where there is one.
double kinetic_energy(const Bodies&);

}  // namespace drumlin::particles
