#pragma once
// Cohesion: constant attraction c of surfaces that touch (gap below a range). Contacts pull up to that force
// before they part, and Coulomb's bound counts it as load. A force before the solve; no unknown of its own.
#include <span>

#include "coupling/documents/key_spec.hpp"
#include "particles/bodies/bodies.hpp"
#include "particles/bodies/free_motion.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/pair_law.hpp"
#include "particles/effects/wall_step.hpp"

namespace drumlin::particles {

struct Cohesion {
  double grain_grain =
      0;  ///< force, in weights of a disc of the mean diameter (of 9.81 m/s2 without gravity)
  double grain_wall = 0;
  double range_d = 1e-3;  ///< in mean diameters
  std::vector<MaterialPair<Cohesion>> pairs = {};
};

inline Allowed value_between(const Cohesion*) { return at_least(0, 1e6); }

template <class Visitor>
void describe(Visitor& v, Cohesion& c) {
  v.value("grain_grain", c.grain_grain,
          required("", at_least(0, 1e6), "Between grains, in weights of the mean disc."));
  v.value("grain_wall", c.grain_wall, required("", at_least(0, 1e6), "With a wall."));
  v.value("range_d", c.range_d, defaulted("d", above(0, 1), "Surfaces closer than this touch."));
  v.tables("pairs", c.pairs, 0, pairs_sentence);
}

/// The law: the force of each pair.
struct CohesionLaw {
  PairLaw force;
  double range = 0;  ///< pairs with a smaller gap attract each other
};
CohesionLaw cohesion_law(const Cohesion&, const std::vector<std::string>& materials);

// Terms in a step.

/// The attraction c h acts on grains and driven walls before the solve; the solver's normal unknown is then
/// r_n + c h >= 0, which it bounds friction by. q changes by W (-c h) through the free velocities.
/// `attraction` receives c h of each pair.
void attract(const CohesionLaw&, std::span<const Candidate> pairs, const Bodies&, const WallStep&,
             const MaterialsOf&, double time_step, FreeMotion&, std::vector<double>& attraction);

}  // namespace drumlin::particles
