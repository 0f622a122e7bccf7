#pragma once
// Names of the contact problems of discs: one type for each combination of a law and bodies that turn or do
// not. Whoever looks into one includes problems.hpp.
#include <variant>

#include "particles/contact_law/contact_laws-inl.h"

namespace drumlin::particles {

template <int dim, bool spin>
class DiscDelassus;
template <class Delassus, class Law>
struct ContactProblem;

#define DRUMLIN_NAME(Problem, Law, spin) \
  using Problem = ContactProblem<DiscDelassus<Law::unknowns, spin>, Law>;
DRUMLIN_EACH_DISC_PROBLEM(DRUMLIN_NAME)
#undef DRUMLIN_NAME

template <template <class...> class Together, template <class> class For, class, class... Problems>
struct OfProblems {
  using type = Together<For<Problems>...>;
};
#define DRUMLIN_NEXT(Problem, Law, spin) , Problem
/// For<Problem>... of all kinds in one type.
template <template <class...> class Together, template <class> class For>
using OfEachKind = typename OfProblems<Together, For, void DRUMLIN_EACH_DISC_PROBLEM(DRUMLIN_NEXT)>::type;
#undef DRUMLIN_NEXT

template <class Problem>
using PointerTo = const Problem*;
/// A problem of any of these kinds.
using DiscProblem = OfEachKind<std::variant, PointerTo>;

}  // namespace drumlin::particles
