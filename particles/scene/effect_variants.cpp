#include "particles/scene/effect_variants.hpp"

#include <algorithm>
#include <cmath>

#include "particles/scene/placement.hpp"
#include "particles/scene/scene_walls.hpp"
#include "particles/scene/sizes.hpp"
#include "particles/scene/validate.hpp"

namespace drumlin::particles {
namespace {

class Variants {
 public:
  explicit Variants(const Scene& scene) : scene_(scene) {
    all_.push_back({"", EffectChange::none, "", scene, ""});
  }

  /// One more variant: the scene, changed by `change(Scene&)`.
  template <class Change>
  void add(const std::string& effect, EffectChange kind, const std::string& with_it, Change change) {
    EffectVariant variant{effect, kind, with_it, scene_, ""};
    change(variant.scene);
    if (const auto faults = validate(variant.scene); !faults.empty())
      variant.refused = faults.front().key + " " + faults.front().what;
    all_.push_back(std::move(variant));
  }
  std::vector<EffectVariant> take() {
    std::stable_sort(all_.begin(), all_.end(), [](const EffectVariant& a, const EffectVariant& b) {
      return static_cast<int>(a.change) < static_cast<int>(b.change);
    });
    return std::move(all_);
  }

 private:
  Scene scene_;
  std::vector<EffectVariant> all_;
};

/// Takes away the effects that lack one that they need, and those that need these in turn; returns their
/// names.
std::string remove_needy(Scene& scene) {
  std::string names;
  for (bool again = true; again;) {
    again = false;
    each_effect(
        [&]<class E>(std::optional<E>& effect) {
          if (!effect || faults_of(*effect, scene).empty()) return;
          effect.reset();
          names += (names.empty() ? "" : " and ") + std::string(E::name);
          again = true;
        },
        scene.effects);
  }
  return names;
}

/// Each effect removed, or added where it can act.
void toggle_effects(const Scene& scene, Variants& variants) {
  Scene changed = scene;
  each_effect(
      [&]<class E>(const std::optional<E>& effect, std::optional<E>& now) {
        std::string words = E::modest_text;
        if (effect) {
          now.reset();
          words = remove_needy(changed);
          if (!words.empty()) words = "and " + words + ", which needs it";
        } else if (faults_of(E::modest(), scene).empty()) {
          now = E::modest();
        } else {
          return;
        }
        variants.add(E::name, effect ? EffectChange::removed : EffectChange::added, words,
                     [&](Scene& s) { s.effects = changed.effects; });
        changed.effects = scene.effects;
      },
      scene.effects, changed.effects);
}

/// Half of the grains of another material, which slides three quarters as well on the first.
void toggle_pairs(const Scene& scene, Variants& variants) {
  const Effects& has = scene.effects;
  const bool named =
      (has.friction && !has.friction->pairs.empty()) || (has.restitution && !has.restitution->pairs.empty());
  if (named)
    variants.add("pairs", EffectChange::removed, "", [](Scene& s) {
      if (s.effects.friction) s.effects.friction->pairs.clear();
      if (s.effects.restitution) s.effects.restitution->pairs.clear();
    });
  else if (has.friction && std::holds_alternative<GeneratedGrains>(scene.grains.source) &&
           scene.grains.materials.empty())
    variants.add("pairs", EffectChange::added, "two materials, 3/4 of the friction between them",
                 [](Scene& s) {
                   s.grains.materials = {{"a"}, {"b"}};
                   s.effects.friction->pairs = {{{"a", "b"}, 0.75 * s.effects.friction->grain_grain}};
                 });
}

/// All grains as large as the mean of their areas: as much sand, of one size.
void toggle_sizes(const Scene& scene, Variants& variants) {
  const auto* grains = std::get_if<GeneratedGrains>(&scene.grains.source);
  if (grains && grains->diameter_min_mm < grains->diameter_max_mm)
    variants.add("sizes", EffectChange::removed, "one size", [](Scene& s) {
      auto& made = std::get<GeneratedGrains>(s.grains.source);
      const double diameter = std::sqrt(mean_power_mm(made, 2));
      made.sizes.reset();
      made.diameter_min_mm = made.diameter_max_mm = diameter;
    });
}

void toggle_walls(const Scene& scene, Variants& variants) {
  const auto rough = [](const Wall& wall) { return wall.rough.has_value(); };
  const double grain_mm = mean_diameter_m(scene.grains) * 1e3;
  if (std::any_of(scene.walls.begin(), scene.walls.end(), rough))
    variants.add("rough walls", EffectChange::removed, "", [](Scene& s) {
      for (Wall& wall : s.walls) wall.rough.reset();
    });
  else if (std::any_of(scene.walls.begin(), scene.walls.end(),
                       [](const Wall& wall) { return wall_length_mm(wall) > 0; }))
    variants.add("rough walls", EffectChange::added,
                 "discs of half the mean diameter, as far apart as a grain", [grain_mm](Scene& s) {
                   for (Wall& wall : s.walls)
                     if (wall_length_mm(wall) > 0) wall.rough = Roughness{grain_mm / 2, grain_mm};
                   // What stands on the wall must not stand in the discs.
                   if (auto* made = std::get_if<GeneratedGrains>(&s.grains.source))
                     if (auto* circle = std::get_if<CircleRegion>(&made->region))
                       circle->radius_mm -= grain_mm / 4;
                 });
  const auto without = [&](const std::string& effect, auto is_of_kind) {
    for (const Stage& stage : scene.stages)
      for (const WallMotion& motion : stage.motions)
        if (is_of_kind(motion)) {
          variants.add(effect, EffectChange::removed, "the walls are at rest", [&](Scene& s) {
            for (Stage& changed : s.stages) std::erase_if(changed.motions, is_of_kind);
          });
          return;
        }
  };
  without("oscillating walls", [](const WallMotion& m) {
    return std::holds_alternative<Oscillation>(m.motion) || std::holds_alternative<Rocking>(m.motion);
  });
  without("walls moved by a force", [](const WallMotion& m) { return is_driven(m); });
}

}  // namespace

std::vector<EffectVariant> effect_variants(const Scene& scene) {
  Variants variants(scene);
  toggle_effects(scene, variants);
  toggle_pairs(scene, variants);
  toggle_sizes(scene, variants);
  toggle_walls(scene, variants);
  return variants.take();
}

}  // namespace drumlin::particles
