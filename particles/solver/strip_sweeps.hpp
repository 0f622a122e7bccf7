#pragma once
// Sweeps a StripProblem, on vectors, threads and ranks, until the stopping rule ends it.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "particles/solver/contact_solver.hpp"
#include "particles/solver/momentum.hpp"
#include "particles/solver/pipelined_sweeps.hpp"
#include "particles/solver/solve_end.hpp"

namespace drumlin::particles {

/// Problems of fewer contacts, which the caches hold, take one sweep at a time; larger ones
/// `longest_pipeline`.
inline constexpr int least_pipelined_contacts = 30000;

/// Where a solve in strips stands between two rounds of sweeps.
template <class T>
struct SweepState {
  int sweeps = 0;
  int sweeps_at_once =
      1;  ///< sweeps at once: momentum goes on through a pipeline and is judged by its steps afterwards
  int rounds = 0;  ///< done
  Momentum momentum;
  T beta = 0;
  bool finite = true;
  double steps = 0;  ///< sum of squares of the steps of the last sweep

  bool loaded = false;     ///< bodies have the impulses that they start from
  bool estimated = false;  ///< the residual, in the last round
  bool keep = false;       ///< the impulses that it left are the best so far
};

/// A thread of a pool, of which so many work and so many are.
struct PoolPlace {
  int thread = 0, threads = 1, size = 1;
};

/// Lets the bodies receive the impulses to start from. meet(phase) is called after a phase.
template <class Strips, class Meet>
void load_share(Strips& strips, const StripShare& share, bool first_thread, Meet meet) {
  for (const int phase : {0, 1}) {
    for (int strip = share.first; strip < share.end; ++strip) strips.load(strip, phase);
    meet(phase);
  }
  if (strips.has_driven()) {
    if (first_thread) strips.load_driven(), strips.start_driven();
    meet(1);
  }
  for (int strip = share.first; strip < share.end; ++strip) strips.start(strip);
}

/// Sweeps on to `until` and, where it is due, computes the residuals of the strips; one thread's share of a
/// pool, which meets the others by calling join().
template <class T, class Strips, class Join>
void sweep_share(Strips& strips, const PoolPlace& at, int until, bool last, SweepExtrapolation how,
                 const SolveEnd& end, SweepState<T>& state, Join join) {
  const bool accelerated = how != SweepExtrapolation::none, first_thread = at.thread == 0;
  const StripShare share = share_of(strips, at.thread, at.threads, at.size);
  const auto together = [&](auto messages) {  // of all ranks
    join();
    if (strips.ranks() == 1) return;
    if (first_thread) messages();
    join();
  };
  const auto meet = [&](int phase) { together([&, phase] { strips.exchange(phase); }); };
  SweepState<T> own = state;
  if (!std::exchange(own.loaded, true)) load_share(strips, share, first_thread, meet);
  while (own.sweeps < until && own.finite) {
    const int sweeps = std::min(own.sweeps_at_once, until - own.sweeps),
              slots = own.rounds++ % 2 * longest_pipeline;
    std::array<T, longest_pipeline> betas{own.beta};
    Momentum expected = own.momentum;
    for (int s = 1; s < sweeps; ++s) betas[s] = static_cast<T>(expected.next_of_falling());
    const auto part = [&](int s, int strip, int phase) {
      if (s == 0 && phase == 0 && own.keep) strips.keep(strip);
      strips.sweep(strip, phase, slots + s, betas[s], how);
    };
    pipelined_sweeps(share, sweeps, part, meet);
    own.keep = false;

    if (strips.has_driven()) {
      if (first_thread) strips.sweep_driven(slots, own.beta, accelerated);
      join();
    }
    if (strips.ranks() > 1)
      together([&] {
        for (int s = 0; s < sweeps; ++s) strips.gather_steps(slots + s);
      });
    own.sweeps += sweeps;
    for (int s = 0; s < sweeps; ++s) {
      own.steps = strips.step_squares(slots + s);
      own.finite = own.finite && std::isfinite(own.steps);
      own.beta = static_cast<T>(own.momentum.next(own.steps));
    }
  }
  own.estimated = end.estimate_due(own.steps, last || !own.finite);
  if (own.estimated)
    for (int strip = share.first; strip < share.end; ++strip)
      for (const int phase : {0, 1}) strips.estimate_residual(strip, phase);
  // All threads have taken their copies: they have met since.
  if (first_thread) state = own;
}

/// Packs a problem and the impulses to start from; returns what turns the squared residuals of its contacts
/// into the square of the relative residual.
template <class Problem, class Strips>
double pack_in_strips(const Problem& problem, SolverWorkspace<Problem>& work, Strips& strips,
                      Solution<Problem>& solution, ParallelLoops& loops) {
  solution.impulses.resize(problem.q.size());
  auto& own = work.strips;
  own.order.clear();
  const bool planned = !problem.W.plan.empty();
  if (!planned) own.plan = sweep_plan(problem.W.fixed(), problem.W.i, problem.W.j, own.order);
  strips.pack(problem, planned ? problem.W.plan : own.plan, own.order, solution.impulses, loops, work.world);
  const double q_squares = squared_reference(problem, loops);
  return q_squares > 0 ? Problem::dim / q_squares : 1;  // rms over contacts, relative to the rms of q
}

/// Whether a problem is large enough to be corrected on a coarse grid, and tells what that needs.
template <class Problem>
bool wants_coarse_loads(const Problem& problem, const SolverWorkspace<Problem>& work) {
  return is_plain<typename Problem::Law> && !problem.W.coupled() && !problem.W.plan.empty() &&
         problem.contacts() >= least_contacts_of_coarse_loads &&
         work.places.x.size() == static_cast<std::size_t>(problem.W.fixed());
}

/// Corrects the impulses of the strips on a coarse grid, laid out anew if this is the `first` time.
template <class T, class Problem, class Strips>
void correct_loads(const Problem& problem, SolverWorkspace<Problem>& work, Strips& strips, bool first,
                   const ParallelLoops& loops, SweepState<T>& state) {
  if constexpr (is_plain<typename Problem::Law>) {
    const auto [first_strip, end_strip] = strips.own();
    if (std::exchange(state.keep, false))
      for (int strip = first_strip; strip < end_strip; ++strip) strips.keep(strip);
    const auto& W = problem.W;
    if (first) {
      work.coarse.use(work.memory);
      work.coarse.lay_out(W.i, W.j, work.places, strips, loops);
    }
    if (!work.coarse.scale(strips, loops)) return;
    strips.rest(loops);
    state.loaded = false;
    state.beta = 0;
  }
}

/// NLGS, plain or accelerated, in precision T, with the residual estimated on vectors and threads.
template <class T, class Problem, class Strips>
SolveReport sweep_in_strips(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>& work,
                            Strips& strips, Solution<Problem>& solution, bool accelerated) {
  ParallelLoops loops(work.pool);
  const WorkMemory::Scope scope(work.memory);
  strips.use(work.memory);
  SolveEnd::Kind kind;
  kind.time_step = problem.time_step, kind.rounding = problem.rounding;
  kind.residual_scale = pack_in_strips(problem, work, strips, solution, loops);
  kind.how = extrapolation_of(accelerated, problem.contacts());
  kind.single = sizeof(T) < sizeof(double);
  kind.steep = accelerated && is_steep(problem);
  // Driven walls take impulses too, which the records do not tell.
  kind.limits_sinking = std::isfinite(rule.sinking) && !strips.has_driven();
  SolveEnd end(rule, kind);
  // Below four strips a second thread costs more than it saves.
  ThreadPool* pool = strips.strips() >= 4 * strips.ranks() ? work.pool : nullptr;
  SweepState<T> state;
  state.momentum = Momentum(rule.tolerance, static_cast<std::size_t>(problem.contacts()));
  if (accelerated && !strips.has_driven() && problem.contacts() >= least_pipelined_contacts)
    state.sweeps_at_once = longest_pipeline;
  const SweptBlocks blocks{[&] {
                             strips.gather_estimates();
                             return strips.residual_estimate();
                           },
                           [&] { return strips.summed_impulses(loops); },
                           [&] { state.keep = true, strips.keep_driven(); },
                           [&](bool kept) {
                             strips.unpack(problem, kept, solution.impulses, loops);
                             return residual_of(problem, solution, loops);
                           }};
  const bool coarse = accelerated && wants_coarse_loads(problem, work);
  int corrected_at = 0;
  for (;;) {
    if (coarse && state.sweeps >= corrected_at + sweeps_between_coarse_loads) {
      correct_loads(problem, work, strips, corrected_at == 0, loops, state);
      corrected_at = state.sweeps;
    }
    const int until = end.next_round(state.sweeps);
    const bool last = end.last(until);
    if (pool)
      pool->run([&](int t, int threads) {
        sweep_share(strips, {t, threads, pool->size()}, until, last, kind.how, end, state,
                    [=] { pool->barrier(); });
      });
    else
      sweep_share(strips, {}, until, last, kind.how, end, state, [] {});
    if (!state.estimated)
      end.leave_out();
    else if (end.ends(blocks, state.sweeps, state.steps, state.finite, last || !state.finite))
      return end.report();
  }
}

}  // namespace drumlin::particles
