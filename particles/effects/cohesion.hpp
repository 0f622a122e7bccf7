#pragma once
// Cohesion: constant attraction c of surfaces that touch (gap below a range). Contacts pull up to that force
// before they part, and Coulomb's bound counts it as load. A force before the solve; no unknown of its own.
#include <numbers>

#include "coupling/core/documents/key_spec.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/law_input.hpp"
#include "particles/effects/pair_law.hpp"

namespace drumlin::particles {

struct Cohesion : PairKeys<Cohesion> {
  static constexpr const char* name = "cohesion";
  static constexpr const char* sentence =
      "Constant attraction of surfaces that touch; counts as load in Coulomb's law.";
  static constexpr const char *modest_text = "one mean weight", *account = "cohesion";
  static Allowed allowed() { return at_least(0, 1e6); }
  static Cohesion modest() { return {{1, 1}}; }

  double range_d = 1e-3;  ///< in mean diameters
};

template <class Visitor>
void describe(Visitor& v, Cohesion& keys) {
  describe_pairs(v, keys, "Between grains, in weights of the mean disc.");
  v.value("range_d", keys.range_d, defaulted("d", above(0, 1), "Surfaces closer than this touch."));
}

/// The law: the force of each pair. A step applies it before the contacts are solved, whose normal unknown is
/// then r_n + c h >= 0, which bounds friction.
struct CohesionLaw {
  PairLaw force;
  double range = 0;  ///< pairs with a smaller gap attract each other

  double attraction(const Candidate& pair, const MaterialsOf& materials) const {
    return pair.gap < range ? value_of(force, pair.i, pair.j, materials) : 0;
  }
};
inline CohesionLaw law_of(const Cohesion& key, const LawInput& in) {
  // Unit: the weight of a disc of diameter 1 and density 1 in gravity 1.
  return {pair_law(key, in.materials, std::numbers::pi / 4), key.range_d};
}

}  // namespace drumlin::particles
