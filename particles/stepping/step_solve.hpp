#pragma once
// The phase of a step that solves its contacts, and those that they bring together.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "particles/stepping/assembly.hpp"
#include "particles/stepping/attract.hpp"
#include "particles/stepping/step_search.hpp"

namespace drumlin::particles {

/// Gives contacts that slide at the bound of `mu` the friction of sliding; false if that changes none.
template <class Problem>
bool let_slide(const StepInput& step, double (*mu)(double of_contact, double sliding),
               StepState<Problem>& s) {
  constexpr double nearly = 1e-6;  // as single precision leaves them
  bool any = false;
  if constexpr (Problem::dim >= 2) {
    bool has_law = false;
    each_law(step.laws, [&](const auto& law) {
      has_law |= requires(const Candidate& pair) { law.sliding_friction(0.0, pair, step.materials()); };
    });
    if (!has_law) return false;
    for (std::size_t a = 0; a < s.contacts.pairs.size(); ++a) {
      double& own = s.problem.mu[Problem::Law::coefficients * a];
      const double sliding = step.sliding_friction(own, s.contacts.pairs[a]);
      const ContactParts r = parts_of<Problem>(s.solution.impulses, a);
      const double bound = mu(own, sliding) * r.normal;
      if (sliding == own || r.normal == 0 || std::abs(std::abs(r.tangential) - bound) > nearly * bound)
        continue;
      own = sliding, any = true;
    }
  }
  return any;
}

/// Assembles the contact problem of the pairs and solves it from the impulses at hand.
template <class Problem>
void solve_pairs(const StepInput& step, ContactSolver<Problem> solver, Stopwatch& watch, StepReport& report,
                 StepState<Problem>& s) {
  attract(step, s.free, s.contacts);
  assemble(step, s.contacts, s.loops(), s.problem);
  report.setup_seconds += watch.lap();
  report.contacts = s.problem.contacts();
  const bool open =
      step.laws.period.open() && step.laws.period.open_z();  // else positions are those of images
  s.work.places = open ? BodyPlaces{step.bodies.x, step.bodies.z} : BodyPlaces{};
  // Those that slid in the step before, whose impulses these are, go on.
  let_slide(
      step, [](double, double sliding) { return sliding; }, s);
  do {
    const SolveReport before = report.solve;
    report.solve = solver(s.problem, s.solver.rule, s.work, s.solution);
    report.solve.sweeps += before.sweeps, report.solve.seconds += before.seconds;
  } while (let_slide(
      step, [](double of_contact, double) { return of_contact; }, s));
  (void)watch.lap();
}

template <class Problem>
void save_contacts(double time_step, StepState<Problem>& s, ImpulseCache& memory) {
  save_contacts(s.order.i(), s.order.j(), s.order.order(), s.solution.impulses, time_step, s.loops(), memory);
}

/// Takes pairs in that solved contacts have brought together, with the impulses so far.
template <class Problem>
void take_in(const StepInput& step, std::span<const Candidate> missed, StepState<Problem>& s) {
  const WorkMemory::Scope scope(&s.memory);
  const auto order = s.order.order();
  auto& taken = s.contacts.pairs;
  ImpulseCache solved;
  save_contacts(step.time_step, s, solved);
  std::vector<Candidate> pairs(taken.size() + missed.size());
  for (std::size_t a = 0; a < taken.size(); ++a) pairs[order[a]] = taken[a];
  const auto added = std::span(pairs).last(missed.size());
  std::copy(missed.begin(), missed.end(), added.begin());
  place_pairs(step, s.beside, s.shifted, added);
  std::inplace_merge(
      pairs.begin(), pairs.end() - missed.size(), pairs.end(),
      [](const Candidate& a, const Candidate& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
  s.order.find(pairs, step.bodies, step.laws.period, s.problem.W.plan);
  taken.resize(pairs.size());
  for (std::size_t a = 0; a < pairs.size(); ++a) taken[a] = pairs[s.order.order()[a]];
  s.warm_starts.find(solved, pairs);
  s.warm_starts.warm_start(solved, Problem::dim, step.time_step, s.order.order(), s.solution.impulses);
  move_freely(step, s);
}

template <class Problem>
void solve(const StepInput& step, ContactSolver<Problem> solver, Stopwatch& watch, StepReport& report,
           StepState<Problem>& s) {
  solve_pairs(step, solver, watch, report, s);
  const FreeMotion& searched = step.laws.restitution ? s.searched : s.free;
  while (s.missed.find(s.end_of(step), searched, s.detection, s.contacts.pairs)) {
    take_in(step, s.missed.pairs(), s);
    solve_pairs(step, solver, watch, report, s);
  }
}

}  // namespace drumlin::particles
