#pragma once
// Coulomb friction: a tangential impulse |r_t| <= mu r_n that opposes sliding. One unknown more per contact.
#include "coupling/core/documents/key_spec.hpp"
#include "particles/contact_law/contact_laws-inl.h"
#include "particles/detection/candidate.hpp"
#include "particles/effects/law_input.hpp"
#include "particles/effects/pair_law.hpp"

namespace drumlin::particles {

struct Friction : PairKeys<Friction> {
  static constexpr const char *name = "friction", *sentence = "Coulomb friction.";
  static constexpr const char* modest_text = "0.3";
  using contact_law = Coulomb;
  static Allowed allowed() { return at_least(0, 100); }
  static Friction modest() { return {{0.3, 0.3}}; }
};

template <class Visitor>
void describe(Visitor& v, Friction& keys) {
  describe_pairs(v, keys, "Between grains.");
}

/// The law: mu of each pair.
inline PairLaw law_of(const Friction& key, const LawInput& in) { return pair_law(key, in.materials); }

// Terms in a step: the tangential row of a contact (contact_law/coulomb-inl.h).

/// mu of a contact; its row of q is tangential_part() of the free relative velocity, and that of the rims
/// where the grains spin (spin.hpp).
inline double friction_bound(const PairLaw& law, const Candidate& pair, const MaterialsOf& materials) {
  return value_of(law, pair.i, pair.j, materials);
}

}  // namespace drumlin::particles
