#include "particles/lab/state_changes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "particles/lab/scalar_sweeps.hpp"
#include "particles/solver/momentum.hpp"

namespace drumlin::particles {

template <class Problem>
std::vector<ContactState> contact_states_of(const Problem& problem, std::span<const double> r) {
  constexpr double rounding = 1e-6;  // of sweeps in single precision
  std::vector<ContactState> states(problem.contacts(), ContactState::open);
  for (int a = 0; a < problem.contacts(); ++a) {
    if (r[2 * a] == 0) continue;
    const bool slides = std::abs(r[2 * a + 1]) >= (1 - rounding) * problem.mu[a] * r[2 * a];
    states[a] = slides ? ContactState::sliding : ContactState::sticking;
  }
  return states;
}

namespace {

void sum_up(StateChanges& found) {
  std::vector<std::int32_t> sorted = found.changes;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  found.total = std::accumulate(sorted.begin(), sorted.end(), std::int64_t{0});
  for (const std::int32_t changes : sorted) found.changed += changes > 0;
  for (std::int64_t sum = 0; 5 * sum < 4 * found.total;) sum += sorted[found.most_of_it++];
}

}  // namespace

template <class Problem>
StateChanges state_changes(const Problem& problem, std::span<const double> r, int sweeps) {
  constexpr double tolerance =
      1e-4;  // the momentum's age at the beginning is that of a solve to this residual
  std::vector<double> now(r.begin(), r.end()), before = now;
  SweptImpulses<Problem> swept(problem, now);
  std::vector<double> state_before(swept.numbers().begin(), swept.numbers().end());
  StateChanges found;
  found.states = contact_states_of(problem, r);
  found.changes.assign(problem.contacts(), 0);
  std::vector<ContactState> last = found.states;
  Momentum momentum(tolerance, found.changes.size());
  for (int k = 0; k < sweeps; ++k) {
    const double beta = momentum.next(sweep(problem, swept));
    const std::vector<ContactState> states = contact_states_of(problem, std::span<const double>(now));
    for (int a = 0; a < problem.contacts(); ++a) found.changes[a] += states[a] != last[a];
    last = states;
    extrapolate(now, before, beta);
    extrapolate(swept.numbers(), state_before, beta);
  }
  sum_up(found);
  return found;
}

#define DRUMLIN_INSTANTIATE(Problem)                                                             \
  template std::vector<ContactState> contact_states_of(const Problem&, std::span<const double>); \
  template StateChanges state_changes(const Problem&, std::span<const double>, int);
DRUMLIN_INSTANTIATE(CoulombSpinProblem)
DRUMLIN_INSTANTIATE(BlockProblem)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
