#pragma once
// Drives the sweeps of a LaneProblem until the judge is content.
#include <chrono>
#include <cmath>
#include <limits>

#include "particles/solver/contact_solver.hpp"
#include "particles/solver/momentum.hpp"

namespace drumlin {

/// What threads tell one another when one of them has called the judge.
struct LaneVerdict {
  SolveReport report;
  bool stop = false;
};

/// NLGS, plain or accelerated, in precision T. Every few sweeps the solver computes its own residual, on
/// vectors and threads; when that is small enough the judge decides. In single precision it also ends, out of
/// sweeps before they are, when the residual stands still or the judge sees more than three times of it.
template <class T, class Problem, class Lanes>
SolveReport sweep_in_lanes(const Problem& problem, const StoppingRule& rule, SolverScratch<Problem>& scratch,
                           Lanes& lanes, std::vector<double>& r, bool accelerated) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  r.resize(problem.q.size());
  auto& own = scratch.lanes;
  if (problem.W.plan.empty())
    own.plan = sweep_plan(static_cast<std::int32_t>(problem.W.inverse_mass.size()) - 1, problem.W.i,
                          problem.W.j, own.order);
  else
    own.order.clear();
  lanes.pack(problem, problem.W.plan.empty() ? own.plan : problem.W.plan, own.order, r);

  double q_squares = 0;
  for (const double q : problem.q) q_squares += q * q;
  // rms over contacts, relative to the rms of q.
  const double residual_scale = q_squares > 0 ? Problem::dim / q_squares : 1;

  LaneVerdict verdict;
  const auto judge_now = [&](int sweeps, bool last, bool finite) {
    lanes.unpack(problem, r);
    auto& report = verdict.report;
    report.sweeps = sweeps;
    report.judgement = judge(problem, std::span<const double>(r), scratch.judge);
    report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    verdict.stop = true;
    if (!finite || std::isnan(report.judgement.residual))
      report.status = Status::not_finite;
    else if (report.judgement.residual <= rule.tolerance && report.judgement.penetration <= rule.penetration)
      report.status = Status::converged;
    else if (last)
      report.status = Status::out_of_sweeps;
    else if (report.seconds > rule.max_seconds)
      report.status = Status::out_of_time;
    else
      verdict.stop = false;
  };

  // Few lanes are not worth waking anybody.
  ThreadTeam* team = lanes.lanes() >= 4 ? scratch.team : nullptr;
  const int threads = team ? team->size() : 1;
  Barrier alone(1);
  Barrier& barrier = team ? team->barrier() : alone;
  constexpr int patience = 100;  // sweeps without a tenth of progress; a flow takes 10 for that
  const auto job = [&](int thread) {
    const int first = lanes.first_lane(thread, threads), end = lanes.first_lane(thread + 1, threads);
    for (const int phase : {0, 1}) {
      for (int lane = first; lane < end; ++lane) lanes.load(lane, phase);
      barrier.meet();
    }
    for (int lane = first; lane < end; ++lane) lanes.start(lane);
    Momentum momentum;
    double beta = 0, best = std::numeric_limits<double>::infinity();
    int best_at = 0;
    for (int sweeps = 1;; ++sweeps) {
      for (const int phase : {0, 1}) {
        if (phase == 0 && sweeps == 1) barrier.meet();  // all bodies are remembered
        for (int lane = first; lane < end; ++lane)
          lanes.sweep(lane, phase, sweeps % 2, static_cast<T>(beta), accelerated);
        barrier.meet();
      }
      const double step_squares = lanes.step_squares(sweeps % 2);
      const bool finite = std::isfinite(step_squares), last = sweeps >= rule.max_sweeps || !finite;
      if (last || sweeps % rule.check_every == 0) {
        for (int lane = first; lane < end; ++lane) lanes.look_at(lane);
        barrier.meet();
        const double seen = std::sqrt(lanes.residual_squares() * residual_scale);
        if (seen < 0.9 * best) best = seen, best_at = sweeps;
        // Rounding of single precision hides the progress.
        const bool stuck = sizeof(T) < sizeof(double) && sweeps - best_at >= patience;
        if (last || stuck || seen <= rule.tolerance || std::isfinite(rule.max_seconds)) {
          if (thread == 0) judge_now(sweeps, last, finite);
          barrier.meet();
          if (verdict.stop || stuck) return;
          if (sizeof(T) < sizeof(double) && verdict.report.judgement.residual > 3 * seen) return;
        }
      }
      beta = momentum.next(step_squares);
    }
  };
  if (team)
    team->run(job);
  else
    job(0);
  return verdict.report;
}

}  // namespace drumlin
