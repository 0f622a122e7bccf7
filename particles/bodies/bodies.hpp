#pragma once
// Grains (discs) as parallel arrays, dimensionless, in the laboratory frame.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace drumlin::particles {

/// One entry per grain. The mass is that of the radius, m = pi r^2 (rho0 = 1, per unit depth), or that
/// of a density of the grain's own; the moment of inertia is that of disc_inertia.hpp.
struct Bodies {
  std::vector<double> x, z;  ///< in a periodic domain not wrapped back: displacements stay meaningful
  std::vector<double> v_x, v_z;
  std::vector<double> spin;  ///< empty when the scene has no spin; positive clockwise as drawn (z up)
  std::vector<double> radius;
  std::vector<double> inverse_mass;
  std::vector<std::uint8_t> material;  ///< empty when no law asks for it
  /// Ascending, never given twice; empty where the number of grains cannot change: the index is the identity.
  std::vector<std::int64_t> id;

  std::size_t count() const { return x.size(); }
};

/// Takes away the grains that are not kept; the others stay in order.
void keep_bodies(std::span<const std::uint8_t> keep, Bodies&);
/// The entries of an array with one per grain that belong to kept grains, in order; an empty array stays so.
template <class T>
void keep_entries(std::span<const std::uint8_t> keep, std::vector<T>& values) {
  if (values.empty()) return;
  std::size_t kept = 0;
  for (std::size_t b = 0; b < keep.size(); ++b)
    if (keep[b]) values[kept++] = values[b];
  values.resize(kept);
}
/// Adds a disc at rest with the mass of its radius.
void add_body(Bodies&, double x, double z, double radius);
double mass_of_disc(double radius);
/// Whether some mass is another than that of its radius.
bool has_own_masses(const Bodies&);
/// Kinetic energy, of the spin too where there is one.
double kinetic_energy(const Bodies&);

}  // namespace drumlin::particles
