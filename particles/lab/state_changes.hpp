#pragma once
// Which contacts go back and forth between open, sticking and sliding while a solution is swept on.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/contact/problems.hpp"
#include "particles/lab/backward_error.hpp"

namespace drumlin::particles {

struct StateChanges {
  std::vector<ContactState> states;   ///< of each contact in the impulses that were given
  std::vector<std::int32_t> changes;  ///< how often each has changed its state
  int changed = 0;                    ///< contacts that did
  std::int64_t total = 0;             ///< changes of all
  int most_of_it = 0;                 ///< the fewest contacts that make 80 % of them
};

/// State of each contact in impulses r (2 per contact, in their cones): open where r_n = 0, sliding where
/// |r_t| = mu r_n to 1e-6, else sticking.
template <class Problem>
std::vector<ContactState> contact_states_of(const Problem&, std::span<const double> r);

/// Sweeps on from r as the solver `accelerated` does, one contact after the other, and counts the changes of
/// state from one sweep to the next. A solution changes nothing; where a solver stands still without being at
/// one, some contacts fold: they find no state to stay in.
template <class Problem>
StateChanges state_changes(const Problem&, std::span<const double> r, int sweeps);

}  // namespace drumlin::particles
