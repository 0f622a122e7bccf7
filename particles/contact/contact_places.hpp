#pragma once
// Where the contacts of a problem are: for pictures, no solver needs it.
#include <vector>

namespace drumlin::particles {

/// One entry per contact, or none where it is not known. In d, x to the right, z upwards. The unit normal
/// points to the grain whose surface the position is on: between two grains, that of the lower number.
struct ContactPlaces {
  std::vector<double> x, z, normal_x, normal_z;
};

}  // namespace drumlin::particles
