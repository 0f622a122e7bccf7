#pragma once
// Normals of pairs that move fast against each other: those of the time at which they meet, or are nearest.
#include <span>

#include "particles/detection/candidate.hpp"
#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// Replaces normal and gap of each pair of discs that moves by more than 0.25 d against each other within the
/// step, as long as they do not touch. A plane through the surfaces as they stand now would stop discs that
/// pass each other: the gap becomes (centre of i - centre of j) . n - (r_i + r_j) with the normal n at the
/// place, on their straight ways, where they meet or else are nearest.
void sweep_normals(const StepInput& step, std::span<Candidate> pairs);

}  // namespace drumlin::particles
