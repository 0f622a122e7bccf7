#pragma once
// Contacts solved by complementary pivots, which end where sweeps swing for ever.
#include <Eigen/Dense>
#include <optional>
#include <span>
#include <type_traits>

#include "particles/contact/solution.hpp"
#include "particles/solver/stopping_rule.hpp"

namespace drumlin::particles {

/// Solves u = W r + q with Coulomb's law of each contact (normal, tangential) by a path as Lemke's. W must be
/// positive semidefinite with a positive diagonal; it is made definite by a millionth of it.
///
/// (r, u) of a contact lies between two neighbours of five rays: r = (1, mu), u_t < 0, u_n > 0, u_t > 0,
/// r = (1, -mu). Opening velocities z > 0 are added to q, so large that all contacts are open, and taken away
/// again along a path of solutions: where a contact loses one of its two rays it goes on to the next one. The
/// path goes through no choice of rays twice, and at large z nothing else is a solution: it ends at z = 0.
/// How long it is nothing says; of some hundred contacts it takes ten to twenty pivots a contact. Returns the
/// impulses, in their cones, or nothing after `most_pivots`.
std::optional<Eigen::VectorXd> solve_by_pivots(Eigen::MatrixXd W, Eigen::VectorXd q,
                                               std::span<const double> mu, int most_pivots);

/// Problems whose contacts settle_clusters() takes: those of Coulomb's law.
template <class Problem>
constexpr bool has_pivots = std::is_same_v<typename Problem::Law, Coulomb>;

/// Solves contacts that miss the rule's tolerance, with those around them, in clusters of some ten contacts,
/// the others as they stand, again and again while that helps. Takes and leaves a solution with its
/// velocities. Each cluster counts as a sweep.
template <class Problem>
SolveReport settle_clusters(const Problem& problem, const StoppingRule& rule, Solution<Problem>& solution);

}  // namespace drumlin::particles
