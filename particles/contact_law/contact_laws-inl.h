// The contact laws: the one list of them. Read once as types, and within each instruction set as their texts
// (law_text-inl.h). A new law is a text, a type and a kind of problem here, and the effect that names it.
#ifdef CONTACT_LAW

#include "particles/contact_law/coulomb-inl.h"
#include "particles/contact_law/coulomb_rolling-inl.h"
#include "particles/contact_law/frictionless-inl.h"

#elif !defined(DRUMLIN_CONTACT_LAWS)
#define DRUMLIN_CONTACT_LAWS
#include <variant>

#include "particles/bodies/disc_inertia.hpp"

namespace drumlin::particles {

struct Frictionless {
  static constexpr int unknowns = 1, coefficients = 0;
};
struct Coulomb {
  static constexpr int unknowns = 2, coefficients = 1;  ///< mu
};
struct CoulombRolling {
  static constexpr int unknowns = 3, coefficients = 2;  ///< mu, mu_r
};
using ContactLaw = std::variant<Frictionless, Coulomb, CoulombRolling>;

// The kinds of contact problems of discs: their names, laws, and whether bodies turn.
// Those of a plain law all methods know.
#define DRUMLIN_EACH_PLAIN_PROBLEM(X)         \
  X(FrictionlessProblem, Frictionless, false) \
  X(CoulombProblem, Coulomb, false) X(CoulombSpinProblem, Coulomb, true)
#define DRUMLIN_EACH_DISC_PROBLEM(X) \
  DRUMLIN_EACH_PLAIN_PROBLEM(X)      \
  X(RollingProblem, CoulombRolling, true)

/// A plain law is Signorini's condition, with Coulomb's friction at most.
template <class Law>
constexpr bool is_plain = Law::coefficients < 2;

}  // namespace drumlin::particles
#endif
