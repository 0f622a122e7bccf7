#pragma once
// Lists of grains as CSV text.
#include <string>
#include <vector>

#include "particles/scene/scene.hpp"

namespace drumlin::particles {

struct ListedGrain {
  double x_mm = 0, z_mm = 0, diameter_mm = 0, v_x_mm_s = 0, v_z_mm_s = 0, spin_rad_s = 0;
  double density_kg_m3 = 0;  ///< 0: not listed
  std::string material;
};

/// The grains of a list. Throws InputError with every fault of the file at once (file, line, column).
std::vector<ListedGrain> listed(const ListedGrains& list);

}  // namespace drumlin::particles
