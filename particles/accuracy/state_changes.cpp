#include "particles/accuracy/state_changes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace drumlin::particles {

template <class Problem>
std::vector<ContactState> contact_states_of(const Problem& problem, std::span<const double> r) {
  std::vector<ContactState> states(problem.contacts());
  for (int a = 0; a < problem.contacts(); ++a)
    states[a] = r[2 * a] == 0                                        ? ContactState::open
                : std::abs(r[2 * a + 1]) >= problem.mu[a] * r[2 * a] ? ContactState::sliding
                                                                     : ContactState::sticking;
  return states;
}

template <class Problem>
StateChanges state_changes(const Problem& problem, std::span<const double> r, int sweeps) {
  std::vector<double> swept(r.begin(), r.end()), step(r.size());
  typename Problem::Delassus::State bodies;
  problem.W.load(bodies, swept);
  StateChanges found;
  found.states = contact_states_of(problem, r);
  found.changes.assign(problem.contacts(), 0);
  std::vector<ContactState> last = found.states;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    problem.W.sweep(problem.q, problem.mu, swept, bodies, step);
    const std::vector<ContactState> now = contact_states_of(problem, std::span<const double>(swept));
    // Impulses that were not left by a sweep meet their cones to a rounding only: the first sweep decides.
    for (int a = 0; sweep > 0 && a < problem.contacts(); ++a) found.changes[a] += now[a] != last[a];
    last = now;
  }
  std::vector<std::int32_t> sorted = found.changes;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  found.total = std::accumulate(sorted.begin(), sorted.end(), std::int64_t{0});
  for (const std::int32_t changes : sorted) found.changed += changes > 0;
  for (std::int64_t sum = 0; 5 * sum < 4 * found.total;) sum += sorted[found.most_of_it++];
  return found;
}

#define DRUMLIN_INSTANTIATE(Problem)                                                             \
  template std::vector<ContactState> contact_states_of(const Problem&, std::span<const double>); \
  template StateChanges state_changes(const Problem&, std::span<const double>, int);
DRUMLIN_INSTANTIATE(CoulombSpinProblem)
DRUMLIN_INSTANTIATE(BlockProblem)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
