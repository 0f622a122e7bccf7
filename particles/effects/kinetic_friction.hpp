#pragma once
// Kinetic friction: a contact that slides has less friction than one that sticks. It sticks with |r_t| <=
// mu_s r_n, or slides with |r_t| = mu_k r_n against u_t. Between the two bounds both are solutions: a contact
// keeps the state that it has, until static friction does not hold it, or kinetic friction stops it.
//
// A solve is one of Coulomb's law, each contact with the coefficient of its state (stepping/step_solve.hpp):
// so its residual is that law's. Those that slide at the bound of static friction then take mu_k, and it is
// solved again until there are none. Dynamic friction (dynamic_friction.hpp) takes the speed of the step
// before.
#include <algorithm>

#include "coupling/core/documents/key_spec.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/law_input.hpp"
#include "particles/effects/pair_law.hpp"

namespace drumlin::particles {

struct KineticFriction : PairKeys<KineticFriction> {
  static constexpr const char *name = "kinetic_friction",
                              *sentence =
                                  "Friction of contacts that slide; effects.friction is that of others.";
  static constexpr const char* modest_text = "0.3";
  static Allowed allowed() { return above(0, 100); }  // at 0 a sliding contact looks like one that sticks
  static KineticFriction modest() { return {{0.3, 0.3}}; }
  void check(const auto& scene, auto refuse) const {
    const auto& friction = scene.effects.friction;
    if (!friction)
      return refuse("acts without friction", "together with effects.friction, or not at all",
                    "effects.friction");
    if (this->grain_grain > friction->grain_grain || this->grain_wall > friction->grain_wall)
      refuse("is above static friction", "at most effects.friction", "effects.friction");
    if (scene.effects.dynamic_friction)
      refuse("is another law of sliding", "one of the two", "effects.dynamic_friction");
  }
};

template <class Visitor>
void describe(Visitor& v, KineticFriction& keys) {
  describe_pairs(v, keys, "mu_k between grains, at most that of effects.friction.");
}

/// The law: mu_k of each pair; above mu_s it counts as that.
struct KineticFrictionLaw {
  PairLaw mu_k;

  double sliding_friction(double mu_s, const Candidate& pair, const MaterialsOf& materials) const {
    return std::min(mu_s, value_of(mu_k, pair.i, pair.j, materials));
  }
};
inline KineticFrictionLaw law_of(const KineticFriction& key, const LawInput& in) {
  return {pair_law(key, in.materials)};
}

}  // namespace drumlin::particles
