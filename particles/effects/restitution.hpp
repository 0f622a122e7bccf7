#pragma once
// Newton restitution: a pair parts with a share e of the normal speed at which it approached. Impacts are
// resolved before the contact problem of a step (stepping/impacts.hpp); no unknown of its own.
#include "coupling/documents/key_spec.hpp"
#include "particles/effects/pair_law.hpp"

namespace drumlin::particles {

struct Restitution {
  double grain_grain = 0;
  double grain_wall = 0;
  std::vector<MaterialPair<Restitution>> pairs = {};
};

inline Allowed value_between(const Restitution*) { return at_least(0, 1); }

template <class Visitor>
void describe(Visitor& v, Restitution& r) {
  v.value("grain_grain", r.grain_grain,
          required("", at_least(0, 1), "Between grains: speed after over before."));
  v.value("grain_wall", r.grain_wall, required("", at_least(0, 1), "With a wall."));
  v.tables("pairs", r.pairs, 0, pairs_sentence);
}

/// The law: e of each pair.
struct RestitutionLaw {
  PairLaw e;
  double gravity = 0;  ///< impacts slower than 2 gravity h are at rest: a grain that lies arrives at gravity
                       ///< h every step
};
inline RestitutionLaw restitution_law(const Restitution& key, const std::vector<std::string>& materials,
                                      double gravity) {
  return {pair_law(key, materials), gravity};
}

/// Approach speed above which a pair is an impact.
inline double slowest_impact(const RestitutionLaw& law, double time_step) {
  return 2 * law.gravity * time_step;
}

}  // namespace drumlin::particles
