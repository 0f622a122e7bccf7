#pragma once
// Newton restitution: a pair parts with a share e of the normal speed at which it approached. Impacts are
// resolved before the contact problem of a step (stepping/impacts.hpp); no unknown of its own.
#include "coupling/core/documents/key_spec.hpp"
#include "particles/effects/law_input.hpp"
#include "particles/effects/pair_law.hpp"

namespace drumlin::particles {

struct Restitution : PairKeys<Restitution> {
  static constexpr const char *name = "restitution", *sentence = "Newton restitution of the normal velocity.";
  static constexpr const char* modest_text = "0.5";
  static Allowed allowed() { return at_least(0, 1); }
  static Restitution modest() { return {{0.5, 0.5}}; }
};

template <class Visitor>
void describe(Visitor& v, Restitution& keys) {
  describe_pairs(v, keys, "Between grains: speed after over before.");
}

/// The law: e of each pair.
struct RestitutionLaw {
  PairLaw e;
};
inline RestitutionLaw law_of(const Restitution& key, const LawInput& in) {
  return {pair_law(key, in.materials)};
}

}  // namespace drumlin::particles
