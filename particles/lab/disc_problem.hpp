#pragma once
// Finds the discs behind a contact problem whose W came as a matrix.
#include <optional>

#include "particles/contact/problems.hpp"
#include "particles/lab/block_delassus.hpp"

namespace drumlin::particles {

/// The same contacts, q, friction and time step with W through the bodies, if W is that of discs with spin:
/// u and the residual then agree to 1e-9. Nothing if it is not; such a problem is solved in blocks.
///
/// Two contacts a and b of one disc of mass m have W_ab = (1/m) [c s; -s c + 2], where c and s are cosine and
/// sine of the angle between the two places on its rim: mass and angle can be read off one block, and a third
/// contact is on the same disc if the three angles close (round three discs that touch one another they miss
/// by half a turn). Walls couple nothing, so that all contacts with them are taken to be with one fixed body.
std::optional<CoulombSpinProblem> disc_problem(const BlockProblem&);

}  // namespace drumlin::particles
