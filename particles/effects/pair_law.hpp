#pragma once
// Coefficient of a contact law (friction, restitution, ...) for each pair of materials: keys and values.
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "coupling/documents/key_spec.hpp"

namespace drumlin::particles {

/// The value of a law between two materials, in place of grain_grain or grain_wall. `Law` tells the values
/// that are allowed: value_between(const Law*).
template <class Law>
struct MaterialPair {
  std::vector<std::string> between;  ///< two names; the same one twice is a material with itself
  double value = 0;
};

inline constexpr const char* pairs_sentence = "In place of the two above, by materials.";

template <class Visitor, class Law>
void describe(Visitor& v, MaterialPair<Law>& p) {
  v.value("between", p.between, required("", not_empty(), "Two names, or one twice."));
  v.value("value", p.value, required("", value_between(static_cast<const Law*>(nullptr)), "Value."));
}

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

/// Place of a material's name among those of the scene; past the end for a name that is none of them.
std::size_t material_place(const std::vector<std::string>& materials, const std::string& name);

/// The law of keys grain_grain, grain_wall and pairs, between materials in the order of their names; grains
/// and walls without a material have the number after the last. `unit` turns values of the scene into those
/// of the simulation.
template <class Effect>
PairLaw pair_law(const Effect& effect, const std::vector<std::string>& materials, double unit = 1) {
  if (effect.pairs.empty()) return PerPair{effect.grain_grain * unit, effect.grain_wall * unit};
  const std::size_t count = materials.size() + 1;
  PerMaterials table{static_cast<int>(count), std::vector<double>(count * count, effect.grain_grain * unit),
                     std::vector<double>(count * count, effect.grain_wall * unit)};
  for (const auto& pair : effect.pairs) {
    const std::size_t a = material_place(materials, pair.between[0]),
                      b = material_place(materials, pair.between[1]);
    for (const std::size_t entry : {a * count + b, b * count + a})
      table.grain_grain[entry] = table.grain_wall[entry] = pair.value * unit;
  }
  return table;
}

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

}  // namespace drumlin::particles
