#pragma once
// The backward error of impulses: how far the contact problem that they solve exactly is from the one that
// was posed (docs/theory/solvers.md, "What a computed step solves exactly").
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/lab/block_delassus.hpp"

namespace drumlin::particles {

/// What a contact does. Numbers as in files.
enum class ContactState : std::int32_t { open = 0, sticking = 1, sliding = 2 };
constexpr int contact_states = 3;

/// A part of the contacts, and what it adds to a backward error.
struct ChangeShare {
  int contacts = 0;
  double share = 0;  ///< of the sum of |dq_a|^2; 0 where that is 0
};

/// The smallest change dq of the free velocities q that makes impulses r exact: u = W r + q + dq, with
/// Signorini's and Coulomb's laws, where the friction of each contact may be any in mu_a (1 - x) to
/// mu_a (1 + x). W stays.
struct BackwardError {
  double friction = 0;  ///< x
  double dq = 0;        ///< rms of |dq_a| over the contacts / rms of all entries of q: the norm of `residual`
  double dq_max = 0;    ///< largest |dq_a| / rms of all entries of q
  /// rms over the contacts of |dq_a| / lambda_max(W_aa), the impulse that would make up for it at this
  /// contact alone, / mean r_n of the contacts that carry one; 0 if none does.
  double force = 0;
  double dr = 0;  ///< rms of |r'_a - r_a| / mean r_n: what was taken in place of r; 0 where r itself is best
  double normal = 0;                               ///< share of the sum of |dq_a|^2 that is in q_n
  std::array<ChangeShare, contact_states> states;  ///< by ContactState, after the change
  int most_of_it = 0;  ///< the fewest contacts that make up 90 % of the sum of |dq_a|^2
};

/// dq_a of each contact, 2 * contacts numbers, for impulses r and their velocities u = W r + q: the shortest
/// way from u_a to the velocities that the law allows with r_a. `states` receives what the contacts do then.
/// Infinity where no velocity fits: r_n < 0, or |r_t| > mu (1 + x) r_n.
std::vector<double> velocity_changes(const BlockProblem&, std::span<const double> r,
                                     std::span<const double> u, double friction,
                                     std::vector<ContactState>& states);

/// The backward error of impulses r (2 per contact) for each x >= 0. Two impulses are tried, and the better
/// is taken for each x: r itself, and r' = P_K(r - rho (u + mu |u_t| n)) contact by contact (as in
/// particles/contact/residual.hpp), for which dq <= (1 + mu + |W diag(rho)|) residual at x = 0. dq never
/// grows with x. Source: backward errors as of Wilkinson 1963; for complementarity problems see the page
/// above.
std::vector<BackwardError> backward_errors(const BlockProblem&, std::span<const double> r,
                                           std::span<const double> friction);

}  // namespace drumlin::particles
