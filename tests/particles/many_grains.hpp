#pragma once
// Grains in bulk for the search of contacts: packed, flowing, falling, scattered, of unlike sizes.
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/scene/random.hpp"

namespace drumlin::test {

/// Discs with the velocities that a search sees, of diameter 1 but where said.
struct Grains {
  particles::Bodies bodies;
  std::vector<double> v_x, v_z;
  void add(double x, double z, double radius, double speed_x, double speed_z);
  std::size_t count() const { return bodies.count(); }
};

/// For which the speeds below are made, sqrt(d/g).
constexpr double grains_time_step = 0.05;

/// A square lattice with places shaken by 0.1 and random velocities up to `speed`; diameters from `smallest`.
Grains packed(int count, double smallest, double speed, particles::RandomStream& random);
/// A packing in a shear flow of rate 0.3.
Grains flowing(int count, particles::RandomStream& random);
/// A packing of which everything falls 1000 diameters a step.
Grains all_fall(int count, particles::RandomStream& random);
/// The upper half falls on the lower one, a diameter a step.
Grains falling(int count, particles::RandomStream& random);
/// A packing and one grain 1e7 diameters away.
Grains with_stray(int count, particles::RandomStream& random);
/// A gas of density 0.02, up to two diameters a step fast.
Grains scattered(int count, particles::RandomStream& random);
/// One to ten in size, fifty small ones in squares beside each large one, all at rest.
Grains unlike(int count, particles::RandomStream& random);

}  // namespace drumlin::test
