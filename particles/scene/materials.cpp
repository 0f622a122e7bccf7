#include "particles/scene/materials.hpp"

#include <algorithm>

namespace drumlin::particles {

std::vector<std::string> material_names(const Scene& scene) {
  std::vector<std::string> names;
  const auto add = [&names](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const GrainMaterial& material : scene.grains.materials) add(material.name);
  for (const Wall& wall : scene.walls)
    if (wall.material) add(*wall.material);
  return names;
}

int material_number(const std::vector<std::string>& names, const std::optional<std::string>& name) {
  if (!name) return static_cast<int>(names.size());
  return static_cast<int>(std::find(names.begin(), names.end(), *name) - names.begin());
}

bool walls_choose_materials(const Scene& scene) {
  return std::any_of(scene.walls.begin(), scene.walls.end(),
                     [](const Wall& wall) { return wall.acts_on.has_value(); });
}

bool materials_matter(const Scene& scene) {
  bool differ = walls_choose_materials(scene);
  each_effect(
      [&differ]<class E>(const std::optional<E>& effect) {
        if constexpr (HasPairs<E>) differ = differ || (effect && !effect->pairs.empty());
      },
      scene.effects);
  return differ;
}

}  // namespace drumlin::particles
