#pragma once
// Newton's method on the few unknowns that hold most of a residual. Private to fem/.
#include <optional>

#include "continuum/fem/detail/assembly.hpp"

namespace drumlin::continuum::fem {

/// The state after Newton steps of those unknowns alone whose residuals stand out, and of what lies around
/// them; all others are kept. Empty where few unknowns do not hold most of the residual, or where nothing
/// came of it.
///
/// Where the material is about to stop, |D| changes by decades from step to step, in a few cells at a time.
/// Each such place would make the whole flow take its many steps; here it takes them by itself, and Newton's
/// method for all unknowns goes on from there: nonlinear elimination (Lanzkron, Rose and Wilkes, SIAM J. Sci.
/// Comput. 17 (1996), who eliminate given unknowns; Cai and Li, SIAM J. Sci. Comput. 33 (2011), those of
/// large residuals). On several ranks its cells may be of any of them.
///
/// `residual` is that of `state`. Without ln g among the unknowns. Collective.
std::optional<State> locally_settled(const FlowProblem& problem, const Discretisation& d,
                                     const Setting& setting, const State& state, const FieldVector& residual);

}  // namespace drumlin::continuum::fem
