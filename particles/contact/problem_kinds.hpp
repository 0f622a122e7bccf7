#pragma once
// Names of the contact problems of discs: one type for each combination of effects. Whoever looks into one
// includes problems.hpp.
#include <variant>

namespace drumlin::particles {

template <int dim, bool spin>
class DiscDelassus;
template <class Delassus>
struct ContactProblem;

using FrictionlessProblem = ContactProblem<DiscDelassus<1, false>>;
using CoulombProblem = ContactProblem<DiscDelassus<2, false>>;  ///< bodies that do not turn
using CoulombSpinProblem = ContactProblem<DiscDelassus<2, true>>;
using RollingProblem = ContactProblem<DiscDelassus<3, true>>;

/// A problem of any of these kinds.
using DiscProblem = std::variant<const FrictionlessProblem*, const CoulombProblem*, const CoulombSpinProblem*,
                                 const RollingProblem*>;

}  // namespace drumlin::particles
