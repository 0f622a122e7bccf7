#pragma once
// Dynamic friction: Coulomb's coefficient goes from that of effects.friction at rest to another one as
// sliding gets fast. A step takes it at the sliding speed at its beginning: an error of first order in the
// time step.
#include <cmath>

#include "coupling/core/documents/key_spec.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/law_input.hpp"
#include "particles/effects/pair_law.hpp"

namespace drumlin::particles {

struct DynamicFriction : PairKeys<DynamicFriction> {
  static constexpr const char *name = "dynamic_friction",
                              *sentence = "Friction of fast sliding; effects.friction is that at rest.";
  static constexpr const char* modest_text = "0.2 above 10 mm/s";
  static Allowed allowed() { return at_least(0, 100); }
  static DynamicFriction modest() { return {{0.2, 0.2}, 10}; }
  void check(const auto& scene, auto refuse) const {
    if (!scene.effects.friction)
      refuse("acts without friction", "together with effects.friction, or not at all", "effects.friction");
  }

  double speed_mm_s = 0;
};

template <class Visitor>
void describe(Visitor& v, DynamicFriction& keys) {
  describe_pairs(v, keys, "mu_d between grains: mu = mu_d + (mu_s - mu_d) exp(-|u_t| / speed).");
  v.value("speed_mm_s", keys.speed_mm_s, required("mm/s", above(0, 1e9), "speed."));
}

/// The law: mu_d of each pair, and the speed.
struct DynamicFrictionLaw {
  PairLaw mu_d;
  double speed = 0;

  double friction(double at_rest, double sliding, const Candidate& pair, const MaterialsOf& materials) const {
    const double fast = value_of(mu_d, pair.i, pair.j, materials);
    return fast + (at_rest - fast) * std::exp(-std::abs(sliding) / speed);
  }
};
inline DynamicFrictionLaw law_of(const DynamicFriction& key, const LawInput& in) {
  return {pair_law(key, in.materials), key.speed_mm_s * 1e-3 / in.scales.velocity_m_s()};
}

}  // namespace drumlin::particles
