#pragma once
// Parts of scene files that tests of several folders put together.
#include <string>

namespace drumlin::test {

/// [grains] with `count` discs of 3 to 3.6 mm in a region, which is an inline table. Seven lines.
inline std::string generated_grains(int count, const std::string& region) {
  return "[grains]\ndensity_kg_m3 = 2700\n[grains.generated]\ncount = " + std::to_string(count) +
         "\ndiameter_min_mm = 3.0\ndiameter_max_mm = 3.6\nregion = " + region + '\n';
}

/// A container of 15 mm named drum. Four lines.
inline std::string drum_wall() {
  return "[[walls]]\nname = \"drum\"\nshape = \"container\"\nradius_mm = 15\n";
}

/// [effects.friction]. Three lines.
inline std::string friction(const std::string& grain_grain, const std::string& grain_wall) {
  return "[effects.friction]\ngrain_grain = " + grain_grain + "\ngrain_wall = " + grain_wall + '\n';
}

}  // namespace drumlin::test
