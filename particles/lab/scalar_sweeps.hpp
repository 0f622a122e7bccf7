#pragma once
// Sweeps one contact after the other, in the order of the problem, whatever the form of W: what the sweeps in
// strips are checked and timed against.
#include <span>
#include <vector>

#include "particles/contact/contact_problem.hpp"

namespace drumlin::particles {

/// Impulses, what they do to the bodies, and the step of the last sweep.
template <class Problem>
struct SweptImpulses {
  std::vector<double>& r;
  typename Problem::Delassus::State state{};
  std::vector<double> step{};

  SweptImpulses(const Problem& problem, std::vector<double>& impulses) : r(impulses) {
    r.resize(problem.q.size());
    step.resize(r.size());
    problem.W.load(state, r);
  }
  /// The numbers of the state, which are linear in those of r.
  std::span<double> numbers() { return Problem::Delassus::numbers(state); }
};

/// One Gauss-Seidel sweep: each contact is solved with the others as they stand. Returns the sum of squares
/// of the step.
template <class Problem>
double sweep(const Problem& problem, SweptImpulses<Problem>& swept) {
  constexpr int dim = Problem::dim;
  double squares = 0;
  for (int a = 0; a < problem.contacts(); ++a) {
    const auto old = contact_law::numbers_at<dim>(&swept.r[dim * a]);
    auto u = problem.W.relative_velocity(swept.state, a);
    for (int e = 0; e < dim; ++e) u[e] += problem.q[dim * a + e];
    const auto fresh = problem.W.solved(typename Problem::Law{}, a, problem.coefficients(a), u, old);
    auto step = fresh;
    for (int e = 0; e < dim; ++e) {
      step[e] -= old[e];
      swept.r[dim * a + e] = fresh[e], swept.step[dim * a + e] = step[e];
      squares += step[e] * step[e];
    }
    problem.W.push(swept.state, a, step);
  }
  return squares;
}

/// Goes on from x by beta times the way from `before`, which becomes x.
inline void extrapolate(std::span<double> x, std::span<double> before, double beta) {
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double swept = x[k];
    x[k] += beta * (swept - before[k]);
    before[k] = swept;
  }
}

}  // namespace drumlin::particles
