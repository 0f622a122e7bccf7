#include "particles/accuracy/state_changes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

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

/// x + beta (x - before); `before` becomes x.
void go_on(std::span<double> x, std::span<double> before, double beta) {
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double swept = x[k];
    x[k] += beta * (swept - before[k]);
    before[k] = swept;
  }
}

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
  using Delassus = typename Problem::Delassus;
  constexpr double tolerance =
      1e-4;  // the momentum's age at the beginning is that of a solve to this residual
  std::vector<double> now(r.begin(), r.end()), before = now, step(r.size());
  typename Delassus::State bodies;
  problem.W.load(bodies, now);
  auto bodies_before = bodies;
  StateChanges found;
  found.states = contact_states_of(problem, r);
  found.changes.assign(problem.contacts(), 0);
  std::vector<ContactState> last = found.states;
  Momentum momentum(tolerance, found.changes.size());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const double beta = momentum.next(problem.W.sweep(problem.q, problem.mu, now, bodies, step));
    const std::vector<ContactState> states = contact_states_of(problem, std::span<const double>(now));
    for (int a = 0; a < problem.contacts(); ++a) found.changes[a] += states[a] != last[a];
    last = states;
    go_on(now, before, beta);
    go_on(Delassus::numbers(bodies), Delassus::numbers(bodies_before), beta);
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
