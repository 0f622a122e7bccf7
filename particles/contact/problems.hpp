#pragma once
// The problems that exist: which cones meet which bodies.
#include "particles/contact/block_delassus.hpp"
#include "particles/contact/body_delassus.hpp"
#include "particles/contact/cone.hpp"
#include "particles/contact/contact_problem.hpp"

namespace drumlin {

using FrictionlessProblem = ContactProblem<Frictionless, BodyDelassus<Frictionless, false>>;
using CoulombProblem = ContactProblem<Coulomb, BodyDelassus<Coulomb, false>>;  ///< bodies that do not turn
using CoulombSpinProblem = ContactProblem<Coulomb, BodyDelassus<Coulomb, true>>;
using BlockProblem = ContactProblem<Coulomb, BlockDelassus>;  ///< from a file

}  // namespace drumlin
