#pragma once
// Distributions of the diameters of generated grains.
#include <vector>

#include "particles/scene/random.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// A diameter, in mm, between diameter_min_mm and diameter_max_mm.
double drawn_diameter_mm(const GeneratedGrains& grains, RandomStream& random);
/// Those of all grains. Of two sizes, and between the sieves of an analysis, there are the nearest whole
/// numbers to their shares, at random places among the others; other distributions are drawn.
std::vector<double> diameters_mm(const GeneratedGrains& grains, RandomStream& random);
/// Mean of the diameter to a power, in mm^power, of the distribution and not of the grains drawn.
double mean_power_mm(const GeneratedGrains& grains, int power);

}  // namespace drumlin::particles
