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

// For each of them, with its numbers of unknowns and whether bodies turn.
#define DRUMLIN_EACH_DISC_PROBLEM(X) \
  X(FrictionlessProblem, 1, false)   \
  X(CoulombProblem, 2, false) X(CoulombSpinProblem, 2, true) X(RollingProblem, 3, true)

/// For<Problem>... of all kinds in one type.
template <template <class...> class Together, template <class> class For>
using OfEachKind =
    Together<For<FrictionlessProblem>, For<CoulombProblem>, For<CoulombSpinProblem>, For<RollingProblem>>;

template <class Problem>
using PointerTo = const Problem*;
/// A problem of any of these kinds.
using DiscProblem = OfEachKind<std::variant, PointerTo>;

}  // namespace drumlin::particles
