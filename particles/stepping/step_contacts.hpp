#pragma once
// The contacts of one step, and what a step that begins knows of everything else.
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/free_motion.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/wall_step.hpp"
#include "particles/stepping/step_laws.hpp"

namespace drumlin::particles {

/// Pairs in solve order and, beside each, what effects keep for it. Kept from step to step: memory alone.
struct StepContacts {
  std::vector<Candidate> pairs;
  std::vector<double> attraction;  ///< cohesive force times h; empty without cohesion
  std::vector<double> approach;    ///< ContactMemory::approach; empty without restitution
  std::vector<char> bounces;       ///< gives back a speed; empty without an energy ledger
};

/// A step from its beginning up to the solve.
struct StepInput {
  const StepLaws& laws;
  const Bodies& bodies;
  const WallStep& walls;
  std::span<const DrivenState> driven;  ///< in the order of walls.driven
  const FreeMotion& free;
  double time_step = 0;

  MaterialsOf materials() const { return {bodies.material, laws.material_of_shape}; }
};

}  // namespace drumlin::particles
