#include "particles/scene/validate_materials.hpp"

#include <fmt/format.h>

#include <set>

#include "particles/scene/materials.hpp"

namespace drumlin::particles {
namespace {

std::string listed_names(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Every pair names two materials of the scene, one of them of grains, and no two pairs are the same.
template <class Law>
void check_pairs(const Scene& scene, const std::vector<MaterialPair<Law>>& pairs, const std::string& law,
                 std::vector<SceneFault>& faults) {
  const auto names = material_names(scene);
  const auto of_grains = scene.grains.materials.size();
  std::set<std::set<std::string>> seen;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const std::string key = fmt::format("effects.{}.pairs.{}.between", law, p);
    const std::vector<std::string> about = {key, "grains.materials", "walls"};
    const auto& between = pairs[p].between;
    bool known = between.size() == 2, grain = false;
    for (const auto& name : between) {
      const auto number = static_cast<std::size_t>(material_number(names, name));
      known = known && number < names.size();
      grain = grain || number < of_grains;
    }
    if (!known)
      faults.push_back({key, "does not name two materials of the scene",
                        names.empty() ? "names from grains.materials or of walls" : listed_names(names),
                        about});
    else if (!grain)
      faults.push_back(
          {key, "names two materials of walls, which never meet", "one of grains.materials", about});
    else if (!seen.insert({between.begin(), between.end()}).second)
      faults.push_back({key, "names the same two materials as a pair before", "each pair once", about});
  }
}

}  // namespace

void check_materials(const Scene& scene, std::vector<SceneFault>& faults) {
  const std::string key = "grains.materials";
  std::set<std::string> names;
  for (std::size_t m = 0; m < scene.grains.materials.size(); ++m)
    if (const auto& name = scene.grains.materials[m].name; !names.insert(name).second)
      faults.push_back({fmt::format("{}.{}.name", key, m),
                        fmt::format("\"{}\" appears twice", name),
                        "a name of its own",
                        {key}});
  if (material_names(scene).size() > most_materials)
    faults.push_back({key,
                      "are too many with those of the walls",
                      fmt::format("at most {}", most_materials),
                      {key, "walls"}});
  for (std::size_t w = 0; w < scene.walls.size(); ++w)
    for (const std::string& name : scene.walls[w].acts_on.value_or(std::vector<std::string>{}))
      if (!names.contains(name))
        faults.push_back({fmt::format("walls.{}.acts_on", w),
                          fmt::format("names no material of grains: \"{}\"", name),
                          "names from grains.materials",
                          {fmt::format("walls.{}.acts_on", w), key}});
  each_effect(
      [&]<class E>(const std::optional<E>& effect) {
        if constexpr (HasPairs<E>)
          if (effect) check_pairs(scene, effect->pairs, E::name, faults);
      },
      scene.effects);
}

}  // namespace drumlin::particles
