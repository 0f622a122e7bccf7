#include "coupling/accuracy/flow_variants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/accuracy/sweep_axes.hpp"
#include "coupling/common/errors.hpp"

namespace drumlin::coupling {
namespace {

const FlowEffect& effect_named(const std::string& name) {
  std::string known;
  for (const FlowEffect& effect : flow_effects()) {
    if (effect.name == name) return effect;
    known += (known.empty() ? "" : ", ") + effect.name;
  }
  throw InputError({InputProblem{.file = {},
                                 .key = "--variants",
                                 .what = fmt::format("'{}' is no effect of a flow", name),
                                 .allowed = "none; " + known + ", joined by +"}});
}

FlowVariant variant_of(const std::string& word) {
  FlowVariant variant{word, {}};
  if (word == "none") return variant;
  for (const std::string& name : parts_between(word, '+')) {
    for (const FlowEffect& before : variant.effects)
      if (before.name == name)
        throw InputError(fmt::format("--variants: {} is named twice in '{}'", name, word));
    variant.effects.push_back(effect_named(name));
  }
  return variant;
}

}  // namespace

const std::vector<FlowEffect>& flow_effects() {
  // k is a part of the law: it has no change of the scene.
  static const std::vector<FlowEffect> effects = {
      {"inertia", "effects.inertia={}", false},
      {"wall_slip", "effects.wall_slip={friction=0.95}", false},
      {"rotating_frame", "effects.rotating_frame={}", false},
      {"k", "", true},
      {"nonlocal", "effects.nonlocal={length=1}", false},
      {"moving_surface", "effects.moving_surface={}", false},
  };
  return effects;
}

bool FlowVariant::needs_k() const {
  return std::any_of(effects.begin(), effects.end(), [](const FlowEffect& effect) { return effect.needs_k; });
}

std::vector<std::string> FlowVariant::changes(
    const std::vector<std::pair<std::string, std::string>>& named) const {
  std::vector<std::string> all;
  for (const FlowEffect& effect : effects) {
    const auto own =
        std::find_if(named.begin(), named.end(), [&](const auto& one) { return one.first == effect.name; });
    if (own != named.end())
      all.push_back(own->second);
    else if (!effect.change.empty())
      all.push_back(effect.change);
  }
  return all;
}

std::vector<FlowVariant> flow_variants(const std::vector<std::string>& words) {
  std::vector<FlowVariant> variants;
  for (const std::string& word : words) variants.push_back(variant_of(word));
  if (words.empty())
    for (const FlowEffect& effect : flow_effects()) variants.push_back({effect.name, {effect}});
  return variants;
}

EffectChanges effect_changes(const FlowNumbers& with, const FlowNumbers& without) {
  EffectChanges changes;
  for (const auto& [name, value] : without.scalars) {
    const double number = number_named(with.scalars, name);
    if (std::isfinite(value) && std::isfinite(number)) changes.scalars.emplace_back(name, number - value);
  }
  changes.v_x = number_named(relative_differences(with, without), "v_x");
  return changes;
}

}  // namespace drumlin::coupling
