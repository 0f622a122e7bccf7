#pragma once
// Names of the contact problems in use: one type for each combination of effects.
#include "particles/contact/block_delassus.hpp"
#include "particles/contact/body_delassus.hpp"
#include "particles/contact/contact_problem.hpp"
#include "particles/contact/general_delassus.hpp"
#include "particles/contact_law/laws.hpp"

namespace drumlin::particles {

using FrictionlessProblem = ContactProblem<Frictionless, BodyDelassus<Frictionless, false>>;
using CoulombProblem = ContactProblem<Coulomb, BodyDelassus<Coulomb, false>>;  ///< bodies that do not turn
using CoulombSpinProblem = ContactProblem<Coulomb, BodyDelassus<Coulomb, true>>;
using CoulombRollingProblem = ContactProblem<CoulombRolling, GeneralDelassus<CoulombRolling, true, false>>;
// With walls that contacts push.
using DrivenFrictionlessProblem = ContactProblem<Frictionless, GeneralDelassus<Frictionless, false, true>>;
using DrivenCoulombProblem = ContactProblem<Coulomb, GeneralDelassus<Coulomb, false, true>>;
using DrivenCoulombSpinProblem = ContactProblem<Coulomb, GeneralDelassus<Coulomb, true, true>>;
using DrivenRollingProblem = ContactProblem<CoulombRolling, GeneralDelassus<CoulombRolling, true, true>>;
using BlockProblem = ContactProblem<Coulomb, BlockDelassus>;  ///< from a file

}  // namespace drumlin::particles
