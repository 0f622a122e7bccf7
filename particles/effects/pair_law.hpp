#pragma once
// A coefficient of contacts (friction, restitution, ...) that depends on who touches whom.
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace drumlin {

/// One value between grains, one between a grain and a wall.
struct PerPair {
  double grain_grain = 0, grain_wall = 0;
};

/// One value for each pair of materials: `materials` squared entries, row and column the materials' numbers.
struct PerMaterials {
  int materials = 0;
  std::vector<double> grain_grain, grain_wall;
};

using PairLaw = std::variant<PerPair, PerMaterials>;

/// Materials of grains and wall shapes as numbers; both empty in a scene in which no law asks for them.
struct MaterialsOf {
  std::span<const std::uint8_t> grain, shape;
};

/// The value between grain i and grain j, or wall shape -1 - j. Asked once per contact and step.
inline double value_of(const PairLaw& law, std::int32_t i, std::int32_t j, const MaterialsOf& materials) {
  if (const auto* both = std::get_if<PerPair>(&law)) return j < 0 ? both->grain_wall : both->grain_grain;
  const auto& table = std::get<PerMaterials>(law);
  const auto row = static_cast<std::size_t>(materials.grain[i]) * table.materials;
  return j < 0 ? table.grain_wall[row + materials.shape[-1 - j]]
               : table.grain_grain[row + materials.grain[j]];
}

}  // namespace drumlin
