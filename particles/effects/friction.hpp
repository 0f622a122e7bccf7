#pragma once
// Coulomb friction: a tangential impulse |r_t| <= mu r_n that opposes sliding. One unknown more per contact.
#include "coupling/documents/key_spec.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/pair_law.hpp"

namespace drumlin::particles {

struct Friction {
  double grain_grain = 0;
  double grain_wall = 0;
  std::vector<MaterialPair<Friction>> pairs = {};
};

inline Allowed value_between(const Friction*) { return at_least(0, 100); }

template <class Visitor>
void describe(Visitor& v, Friction& f) {
  v.value("grain_grain", f.grain_grain, required("", at_least(0, 100), "Between grains."));
  v.value("grain_wall", f.grain_wall, required("", at_least(0, 100), "With a wall."));
  v.tables("pairs", f.pairs, 0, pairs_sentence);
}

/// The law: mu of each pair.
inline PairLaw friction_law(const Friction& key, const std::vector<std::string>& materials) {
  return pair_law(key, materials);
}

// Terms in a step: the tangential row of a contact of types Coulomb and CoulombRolling (contact/cone.hpp).

/// mu of a contact; its row of q is tangential_part() of the free relative velocity, and that of the rims
/// where the grains spin (spin.hpp).
inline double friction_bound(const PairLaw& law, const Candidate& pair, const MaterialsOf& materials) {
  return value_of(law, pair.i, pair.j, materials);
}

}  // namespace drumlin::particles
