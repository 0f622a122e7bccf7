#pragma once
// Numbers of the materials of a scene.
#include <optional>
#include <string>
#include <vector>

#include "particles/scene/scene.hpp"

namespace drumlin::particles {

constexpr int most_materials = 200;

/// Names of all materials of a scene, those of the grains first, each once. A material's number is its place;
/// grains and walls without a material have the number after the last.
std::vector<std::string> material_names(const Scene& scene);
/// The number of a name, or of none.
int material_number(const std::vector<std::string>& names, const std::optional<std::string>& name);
/// Whether a wall acts on some materials alone.
bool walls_choose_materials(const Scene& scene);
/// Whether a law of the scene differs from pair to pair, or walls choose: only then materials are stored.
bool materials_matter(const Scene& scene);

}  // namespace drumlin::particles
