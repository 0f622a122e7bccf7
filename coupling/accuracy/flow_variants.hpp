#pragma once
// Variants of a flow scene that differ by their effects, and what an effect changes.
#include <string>
#include <vector>

#include "coupling/accuracy/flow_sweep.hpp"
#include "coupling/accuracy/work_point.hpp"

namespace drumlin::coupling {

/// An effect of a flow, as a variant adds it to a scene without any.
struct FlowEffect {
  std::string name;
  std::string change;    ///< as for --set; empty: it is a part of the law
  bool needs_k = false;  ///< acts with a law that has k(I) alone
};
/// All of them, each at the strength that a scene which does not name it gets.
const std::vector<FlowEffect>& flow_effects();

struct FlowVariant {
  std::string name;  ///< the effects joined by +, or "none"
  std::vector<FlowEffect> effects;
  bool needs_k() const;
  /// All changes of its effects; the change of an effect that the scene names itself is in `named`, by
  /// effect.
  std::vector<std::string> changes(const std::vector<std::pair<std::string, std::string>>& named) const;
};

/// The variants that the words name, such as "inertia+k" and "none"; without any word each effect alone.
/// Throws InputError for an effect that is none of `flow_effects`, or named twice in a word.
std::vector<FlowVariant> flow_variants(const std::vector<std::string>& words);

/// What a variant changes, against the flow without any effect.
struct EffectChanges {
  NamedNumbers scalars;  ///< differences, in the units of the scalars
  double v_x = 0;  ///< rms of the difference of the profiles over rms of that without; NaN: other layers
};
EffectChanges effect_changes(const FlowNumbers& with, const FlowNumbers& without);

}  // namespace drumlin::coupling
