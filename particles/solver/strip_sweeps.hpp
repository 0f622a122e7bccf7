#pragma once
// Sweeps a StripProblem, on vectors and threads, until the stopping rule ends it.
#include <cmath>
#include <limits>

#include "particles/solver/contact_solver.hpp"
#include "particles/solver/momentum.hpp"

namespace drumlin::particles {

/// NLGS, plain or accelerated, in precision T. Every few sweeps the solver estimates its residual, on vectors
/// and threads; when that is small enough the residual itself decides. In single precision it also ends, out
/// of sweeps before they are, when the estimate stands still or the residual is more than three times of it.
template <class T, class Problem, class Strips>
SolveReport sweep_in_strips(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>& work,
                            Strips& strips, Solution<Problem>& solution, bool accelerated) {
  StoppingTest test(rule);
  solution.impulses.resize(problem.q.size());
  auto& own = work.strips;
  if (problem.W.plan.empty())
    own.plan = sweep_plan(static_cast<std::int32_t>(problem.W.inverse_mass.size()) - 1, problem.W.i,
                          problem.W.j, own.order);
  else
    own.order.clear();
  strips.pack(problem, problem.W.plan.empty() ? own.plan : problem.W.plan, own.order, solution.impulses);

  double q_squares = 0;
  for (const double q : problem.q) q_squares += q * q;
  // rms over contacts, relative to the rms of q.
  const double residual_scale = q_squares > 0 ? Problem::dim / q_squares : 1;

  bool ended = false;  // what the threads tell one another
  const auto look = [&](int sweeps, bool finite) {
    strips.unpack(problem, solution.impulses);
    ended = test.ends(sweeps, residual_of(problem, solution), finite);
  };

  // Below four strips a second thread costs more than it saves.
  ThreadTeam* team = strips.strips() >= 4 ? work.team : nullptr;
  const int threads = team ? team->size() : 1;
  Barrier alone(1);
  Barrier& barrier = team ? team->barrier() : alone;
  constexpr int patience = 100;  // sweeps without a tenth of progress; a flow takes 10 for that
  const auto job = [&](int thread) {
    const int first = strips.first_strip(thread, threads), end = strips.first_strip(thread + 1, threads);
    for (const int phase : {0, 1}) {
      for (int strip = first; strip < end; ++strip) strips.load(strip, phase);
      barrier.meet();
    }
    for (int strip = first; strip < end; ++strip) strips.start(strip);
    Momentum momentum;
    double beta = 0, best = std::numeric_limits<double>::infinity();
    int best_at = 0;
    for (int sweeps = 1;; ++sweeps) {
      for (const int phase : {0, 1}) {
        if (phase == 0 && sweeps == 1) barrier.meet();  // all bodies are remembered
        for (int strip = first; strip < end; ++strip)
          strips.sweep(strip, phase, sweeps % 2, static_cast<T>(beta), accelerated);
        barrier.meet();
      }
      const double step_squares = strips.step_squares(sweeps % 2);
      const bool finite = std::isfinite(step_squares), last = sweeps >= rule.max_sweeps || !finite;
      if (!finite || test.due(sweeps)) {
        for (int strip = first; strip < end; ++strip) strips.look_at(strip);
        barrier.meet();
        const double seen = std::sqrt(strips.residual_squares() * residual_scale);
        if (seen < 0.9 * best) best = seen, best_at = sweeps;
        // Rounding of single precision hides the progress.
        const bool stuck = sizeof(T) < sizeof(double) && sweeps - best_at >= patience;
        if (last || stuck || seen <= rule.tolerance || std::isfinite(rule.max_seconds)) {
          if (thread == 0) look(sweeps, finite);
          barrier.meet();
          if (ended || stuck) return;
          if (sizeof(T) < sizeof(double) && test.report().residual.rms > 3 * seen) return;
        }
      }
      beta = momentum.next(step_squares);
    }
  };
  if (team)
    team->run(job);
  else
    job(0);
  return test.report();
}

}  // namespace drumlin::particles
