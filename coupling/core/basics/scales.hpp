#pragma once
// Units: inside the libraries lengths are in d (mean grain diameter), times in sqrt(d/g), stresses in rho0 g
// d.
namespace drumlin {

/// What one unit is in SI. Travels with every file.
struct Scales {
  double length_m = 0;       ///< d
  double time_s = 0;         ///< sqrt(d/g)
  double density_kg_m3 = 0;  ///< rho0, the density of a disc
  double velocity_m_s() const { return length_m / time_s; }
  double stress_Pa() const { return density_kg_m3 * velocity_m_s() * velocity_m_s(); }
};

/// Scales of grains of mean diameter d in gravity g (9.81 m/s2 serves as the unit where a scene has no
/// gravity).
Scales scales_of(double mean_diameter_m, double gravity_m_s2, double density_kg_m3);

}  // namespace drumlin
