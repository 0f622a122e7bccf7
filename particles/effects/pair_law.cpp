#include "particles/effects/pair_law.hpp"

#include <algorithm>

namespace drumlin::particles {

std::size_t material_place(const std::vector<std::string>& materials, const std::string& name) {
  return static_cast<std::size_t>(std::find(materials.begin(), materials.end(), name) - materials.begin());
}

}  // namespace drumlin::particles
