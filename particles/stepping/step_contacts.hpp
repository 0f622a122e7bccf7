#pragma once
// The contacts of one step, and what a step that begins knows of everything else.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/vectors.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/moving_cell.hpp"
#include "particles/effects/wall_step.hpp"
#include "particles/stepping/step_laws.hpp"

namespace drumlin::particles {

inline Point normal(const Candidate& pair) { return {pair.n_x, pair.n_z}; }
inline void set_normal(Candidate& pair, const Point& n) { pair.n_x = n.x, pair.n_z = n.z; }
inline Point wall_velocity(const Candidate& pair) { return {pair.wall_v_x, pair.wall_v_z}; }
inline void set_wall_velocity(Candidate& pair, const Point& v) { pair.wall_v_x = v.x, pair.wall_v_z = v.z; }

/// An impact of a pair (i, j), in one pass (impacts.hpp): its normal, and its impulses.
struct ImpactImpulse {
  std::int32_t i = 0, j = 0;
  double n_x = 0, n_z = 0;
  double normal = 0, tangential = 0;
};

/// Pairs in solve order and, beside each, what effects keep for it. Kept from step to step: memory alone.
struct StepContacts {
  std::vector<Candidate> pairs;
  std::vector<double> attraction;      ///< of its surfaces, times h; empty where nothing attracts
  std::vector<ImpactImpulse> impacts;  ///< impacts of the step; empty without restitution
  std::vector<double> wall_jumps;      ///< what they add to the velocity of each driven wall

  double attraction_of(std::size_t a) const { return attraction.empty() ? 0 : attraction[a]; }
};

/// A step from its beginning up to the solve.
struct StepInput {
  const StepLaws& laws;
  const Bodies& bodies;
  const WallStep& walls;
  std::span<const DrivenState> driven;  ///< in the order of walls.driven
  const FreeMotion& free;
  double time_step = 0;
  CellResponse cell = {};  ///< of a cell that pressures move

  /// How grains answer impulses.
  std::span<const double> inverse_mass() const {
    return free.inverse_mass.empty() ? bodies.inverse_mass : free.inverse_mass;
  }
  MaterialsOf materials() const { return {bodies.material, laws.material_of_shape}; }
  /// Coefficient of friction of a pair; sliding() is its sliding velocity, for laws that ask for it.
  template <class Sliding>
  double friction(const Candidate& pair, Sliding sliding) const {
    double mu = friction_bound(*laws.friction, pair, materials());
    each_law(laws, [&](const auto& law) {
      if constexpr (requires { law.friction(mu, 0.0, pair, materials()); })
        mu = law.friction(mu, sliding(), pair, materials());
    });
    return mu;
  }
  /// What becomes of it where the contact slides.
  double sliding_friction(double mu, const Candidate& pair) const {
    each_law(laws, [&](const auto& law) {
      if constexpr (requires { law.sliding_friction(mu, pair, materials()); })
        mu = law.sliding_friction(mu, pair, materials());
    });
    return mu;
  }
};

}  // namespace drumlin::particles
