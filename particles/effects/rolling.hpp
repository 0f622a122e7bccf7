#pragma once
// Rolling resistance: a couple of at most mu_r R_eff r_n that opposes rolling. One unknown more per contact;
// needs spin.
#include "coupling/core/documents/key_spec.hpp"
#include "particles/bodies/bodies.hpp"
#include "particles/contact_law/contact_laws-inl.h"
#include "particles/detection/candidate.hpp"
#include "particles/effects/law_input.hpp"
#include "particles/effects/pair_law.hpp"
#include "particles/effects/wall_step.hpp"

namespace drumlin::particles {

struct RollingResistance : PairKeys<RollingResistance> {
  static constexpr const char *name = "rolling_resistance",
                              *sentence = "A couple that opposes rolling; needs spin.";
  static constexpr const char *modest_text = "0.1", *account = "rolling";
  using contact_law = CoulombRolling;
  static Allowed allowed() { return at_least(0, 100); }
  static RollingResistance modest() { return {{0.1, 0.1}}; }
  void check(const auto& scene, auto refuse) const {
    if (!scene.effects.spin)
      refuse("acts without spin", "together with effects.spin, or not at all", "effects.spin");
    if (scene.solver.capture_unconverged > 0)
      refuse("gives contacts a third unknown, which files of contact problems cannot hold",
             "with solver.capture_unconverged = 0", "solver.capture_unconverged");
  }
};

template <class Visitor>
void describe(Visitor& v, RollingResistance& keys) {
  describe_pairs(v, keys, "mu_r between grains: a couple up to mu_r R r_n, 1/R = 1/r_i + 1/r_j.",
                 "With a wall; R the grain's radius.");
}

/// The law: mu_r of each pair. Its couple is the third unknown of a contact.
struct RollingLaw {
  PairLaw mu_r;

  /// R_eff / r_i of a pair; a wall counts as flat.
  static double radius_ratio(const Candidate& pair, const Bodies& bodies) {
    return pair.j < 0 ? 1 : bodies.radius[pair.j] / (bodies.radius[pair.i] + bodies.radius[pair.j]);
  }
  /// Part of a turning wall in the rolling velocity.
  static double wall_part(const Candidate& pair, const Bodies& bodies, const WallStep& walls,
                          double time_step) {
    return pair.j < 0 ? bodies.radius[pair.i] * walls.displacement[-1 - pair.j].angle / time_step : 0;
  }
  /// Rolling velocity of a pair with that ratio of radii.
  static double couple_velocity(const Candidate& pair, const Bodies& bodies, const WallStep& walls,
                                double radius_ratio, double time_step) {
    const double rim_j = pair.j < 0 ? wall_part(pair, bodies, walls, time_step)
                                    : (1 - radius_ratio) * bodies.radius[pair.j] * bodies.spin[pair.j];
    return radius_ratio * bodies.radius[pair.i] * bodies.spin[pair.i] - rim_j;
  }
  double coefficient(const Candidate& pair, const MaterialsOf& materials) const {
    return value_of(mu_r, pair.i, pair.j, materials);
  }
};
inline RollingLaw law_of(const RollingResistance& key, const LawInput& in) {
  return {pair_law(key, in.materials)};
}

}  // namespace drumlin::particles
