#pragma once
// Makes and places the grains that a scene asks for.
#include "particles/bodies/bodies.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// Mean diameter in metres: of the distribution, or of the grains listed, groups aside. It is the unit of
/// length.
double mean_diameter_m(const Grains& grains);

/// Bodies of a scene, dimensionless, at rest or with the listed velocities. Generated grains stand on a
/// triangular lattice of spacing 1.03 largest diameters, shaken by what room that leaves, filling the region
/// from below, around the walls that they are placed around; those of a distribution of sizes at random
/// (sequential_placement.hpp), deposited ones in hollows (deposited_placement.hpp). Throws InputError if the
/// region is too small for them, the list is faulty (file, line), or grains of different groups overlap.
Bodies place_grains(const Scene& scene, const Scales& scales);

/// Places of all grains that are listed.
std::vector<Point_mm> listed_places_mm(const Grains& grains);

/// How many grains of their largest diameter fit into the region of generated grains of the scene.
int capacity(const GeneratedGrains& grains, const Scene& scene);

}  // namespace drumlin::particles
