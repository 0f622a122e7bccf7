#pragma once
// A grain that slides or rolls on one wall and touches nothing else: its step by the midpoint rule, which is
// of second order and keeps the energy of a motion without losses. The implicit step of contacts between many
// grains turns a velocity into the tangent at the step's end and loses what is across: a share of
// (displacement / radius)^2 / 2 a step.
#include <optional>

#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// What the contact gives the grain, per unit of its mass, and where the step ends.
struct LoneStep {
  Point n;  ///< normal halfway: impulses act along it and its tangent
  double normal = 0, tangential = 0;
  Point wall_velocity;  ///< of the surface, with that normal
  Point end;            ///< of the centre
};

/// The step of grain pair.i, which carried a load of this wall, which no force moves, in the last step. With
/// Coulomb friction mu. Without impulses where the grain leaves the wall; none where the wall bends sharply
/// within the step.
std::optional<LoneStep> lone_step(const StepInput& step, const Candidate& pair, double mu);

}  // namespace drumlin::particles
