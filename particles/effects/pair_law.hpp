#pragma once
// Coefficient of a contact law (friction, restitution, ...) for each pair of materials: keys and values.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "coupling/core/documents/key_spec.hpp"

namespace drumlin::particles {

/// The value of a law between two materials, in place of grain_grain or grain_wall.
template <class Effect>
struct MaterialPair {
  std::vector<std::string> between;  ///< two names; the same one twice is a material with itself
  double value = 0;
};

template <class Visitor, class Effect>
void describe(Visitor& v, MaterialPair<Effect>& p) {
  v.value("between", p.between, required("", not_empty(), "Two names, or one twice."));
  v.value("value", p.value, required("", Effect::allowed(), "Value."));
}

/// Two values of a law; within one stage those in place of the effect's and of its pairs.
template <class Effect>
struct StageValues {
  double grain_grain = 0;
  double grain_wall = 0;
};

/// The values lie within Effect::allowed().
template <class Visitor, class Effect>
void describe(Visitor& v, StageValues<Effect>& values, const std::string& of_grains = "Between grains.",
              const std::string& of_wall = "With a wall.") {
  v.value("grain_grain", values.grain_grain, required("", Effect::allowed(), of_grains));
  v.value("grain_wall", values.grain_wall, required("", Effect::allowed(), of_wall));
}

/// The keys of an effect that has a value for each pair of materials: its base.
template <class Effect>
struct PairKeys : StageValues<Effect> {
  std::vector<MaterialPair<Effect>> pairs = {};
};

template <class Visitor, class Effect, class... Sentences>
void describe_pairs(Visitor& v, PairKeys<Effect>& keys, const Sentences&... sentences) {
  describe(v, static_cast<StageValues<Effect>&>(keys), sentences...);
  v.tables("pairs", keys.pairs, 0, "In place of the two above, by materials.");
}

/// The values of a law: between grains, and between a grain and a wall, for each pair of the materials that
/// it tells apart. `materials` squared entries, row and column the materials' numbers.
struct PairLaw {
  std::size_t materials = 1;
  std::vector<double> grain_grain, grain_wall;
};

/// The law of keys, between materials in the order of their names; grains and walls without a material have
/// the number after the last. `unit` turns values of the scene into those of the simulation.
template <class Effect>
PairLaw pair_law(const PairKeys<Effect>& keys, const std::vector<std::string>& materials, double unit = 1) {
  const std::size_t count = keys.pairs.empty() ? 1 : materials.size() + 1;
  PairLaw law{count, std::vector<double>(count * count, keys.grain_grain * unit),
              std::vector<double>(count * count, keys.grain_wall * unit)};
  const auto number = [&materials](const std::string& name) {
    return static_cast<std::size_t>(std::find(materials.begin(), materials.end(), name) - materials.begin());
  };
  for (const auto& pair : keys.pairs) {
    const std::size_t a = number(pair.between[0]), b = number(pair.between[1]);
    for (const std::size_t entry : {a * count + b, b * count + a})
      law.grain_grain[entry] = law.grain_wall[entry] = pair.value * unit;
  }
  return law;
}

/// Materials of grains and wall shapes as numbers; both empty in a scene in which no law asks for them.
struct MaterialsOf {
  std::span<const std::uint8_t> grain, shape;
};

/// The value between grain i and grain j, or wall shape -1 - j. Asked once per contact and step.
inline double value_of(const PairLaw& law, std::int32_t i, std::int32_t j, const MaterialsOf& materials) {
  const auto& values = j < 0 ? law.grain_wall : law.grain_grain;
  if (law.materials == 1) return values[0];
  return values[materials.grain[i] * law.materials + (j < 0 ? materials.shape[-1 - j] : materials.grain[j])];
}

}  // namespace drumlin::particles
