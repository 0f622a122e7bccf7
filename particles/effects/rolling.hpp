#pragma once
// Rolling resistance: a couple of at most mu_r R_eff r_n that opposes rolling. One unknown more per contact;
// needs spin.
#include "coupling/documents/key_spec.hpp"
#include "particles/bodies/bodies.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/pair_law.hpp"
#include "particles/effects/wall_step.hpp"

namespace drumlin::particles {

struct RollingResistance {
  double grain_grain = 0;
  double grain_wall = 0;
  std::vector<MaterialPair<RollingResistance>> pairs = {};
};

inline Allowed value_between(const RollingResistance*) { return at_least(0, 100); }

template <class Visitor>
void describe(Visitor& v, RollingResistance& r) {
  v.value(
      "grain_grain", r.grain_grain,
      required("", at_least(0, 100), "mu_r between grains: a couple up to mu_r R r_n, 1/R = 1/r_i + 1/r_j."));
  v.value("grain_wall", r.grain_wall, required("", at_least(0, 100), "With a wall; R the grain's radius."));
  v.tables("pairs", r.pairs, 0, pairs_sentence);
}

/// The law: mu_r of each pair.
inline PairLaw rolling_law(const RollingResistance& key, const std::vector<std::string>& materials) {
  return pair_law(key, materials);
}

// Terms in a step: the rolling row of a contact of type CoulombRolling (contact/cone.hpp).

/// R_eff / r_i of a pair; a wall counts as flat.
inline double lever_of(const Candidate& pair, const Bodies& bodies) {
  return pair.j < 0 ? 1 : bodies.radius[pair.j] / (bodies.radius[pair.i] + bodies.radius[pair.j]);
}

/// Angular velocity of a wall's shape over the step.
inline double wall_spin(const Candidate& pair, const WallStep& walls, double time_step) {
  return walls.displacement[-1 - pair.j].angle / time_step;
}

/// Free rolling velocity of a pair with that lever.
inline double rolling_velocity(const Candidate& pair, const Bodies& bodies, const WallStep& walls,
                               double lever, double time_step) {
  const double r_i = bodies.radius[pair.i], r_j = pair.j < 0 ? 0 : bodies.radius[pair.j];
  const double rim_j = pair.j < 0 ? r_i * walls.displacement[-1 - pair.j].angle / time_step
                                  : (1 - lever) * r_j * bodies.spin[pair.j];
  return lever * r_i * bodies.spin[pair.i] - rim_j;
}

/// mu_r of a contact.
inline double rolling_bound(const PairLaw& law, const Candidate& pair, const MaterialsOf& materials) {
  return value_of(law, pair.i, pair.j, materials);
}

}  // namespace drumlin::particles
