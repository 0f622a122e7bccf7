#pragma once
// Newton restitution: a pair parts with a share e of the normal speed at which it approached. Changes the
// normal entry of q; no unknown of its own.
#include <algorithm>

#include "coupling/documents/key_spec.hpp"
#include "particles/detection/candidate.hpp"
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
          required("", at_least(0, 1), "Share of the normal approach speed that two grains part with."));
  v.value("grain_wall", r.grain_wall, required("", at_least(0, 1), "The same between a grain and a wall."));
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

// Terms in a step: what Signorini's law acts on beside u_n.

/// Without restitution: a contact may act before it touches, u_n >= -gap/h.
inline double predicted_gap(double gap, double time_step) { return gap > 0 ? gap / time_step : 0; }

struct Impact {
  double shift = 0;  ///< of u_n
  bool bounces = false;
};

/// A remembered approach means an impact whatever the sign of the tiny gap that the solver's error left.
inline Impact impact_of(double gap, double u_before, double remembered, double e, double slowest,
                        double time_step) {
  double approach = remembered;
  if (gap <= 0) approach = std::min(approach, u_before);
  if (approach < -slowest) return {e * approach, true};
  return {predicted_gap(gap, time_step), false};
}

/// Speed at which a pair with a gap arrives, from the speeds at the beginning and (without contact) the end
/// of the step.
inline double arrival_speed(double gap, double u_before, double u_free, double time_step) {
  if (u_free >= 0) return u_before;
  const double fraction = std::min(1.0, gap / (-u_free * time_step));
  return u_before + fraction * (u_free - u_before);
}

/// Shift of u_n of a contact with normal speeds `u_before` and `u_free`. `approach`: in, what the contact
/// remembers of the last step; out, what the next one must know if it acts.
inline double restitution_shift(const RestitutionLaw& law, const Candidate& pair,
                                const MaterialsOf& materials, double u_before, double u_free,
                                double time_step, double& approach) {
  const double e = value_of(law.e, pair.i, pair.j, materials);
  const double slowest = 2 * law.gravity * time_step;
  const Impact impact = impact_of(pair.gap, u_before, approach, e, slowest, time_step);
  const double arrives =
      pair.gap > 0 && !impact.bounces ? arrival_speed(pair.gap, u_before, u_free, time_step) : 0;
  approach = arrives < -slowest ? arrives : 0;
  return impact.shift;
}

}  // namespace drumlin::particles
