#pragma once
// The first phase of a step: the pairs that may touch, once its impacts are over, in the order of the solve,
// with the impulses to start from.
#include <cmath>
#include <span>
#include <vector>

#include "particles/stepping/meeting.hpp"
#include "particles/stepping/set_free_motion.hpp"
#include "particles/stepping/step_state.hpp"

namespace drumlin::particles {

// Rounds of impacts within a step, which may throw grains into pairs that no search has found.
inline constexpr int most_searches = 5;

/// Velocities without contacts, attractions aside: their pairs are not known yet.
template <class Problem>
void move_freely(const StepInput& step, StepState<Problem>& s) {
  set_free_motion(step.bodies, step.laws, step.time_step, s.loops(), s.free);
  s.free.driven.clear();
  for (std::size_t k = 0; k < step.driven.size(); ++k)
    s.free.driven.push_back(free_velocity(step.walls.driven[k], step.driven[k], step.time_step) +
                            s.contacts.wall_jumps[k]);
}

inline DetectionInput detection_input(const StepInput& step) {
  return {step.walls.before, step.walls.displacement, step.time_step, step.laws.detection_margin,
          step.laws.period};
}

/// The grains that impacts have hit harder than the search for pairs allowed for; false if none.
template <class Problem>
bool find_collided(const StepInput& step, StepState<Problem>& s) {
  s.collided.clear();
  for (const CollidedGrain& collided : s.impacts.collided()) {
    const std::int32_t b = collided.grain;
    const double displacement =
        2 * step.time_step * std::hypot(s.free.x[b] - s.searched.x[b], s.free.z[b] - s.searched.z[b]);
    if (displacement <= s.detection.displacement_bound(b) + step.laws.detection_margin) continue;
    s.collided.push_back({b, displacement});
    s.searched.x[b] = s.free.x[b], s.searched.z[b] = s.free.z[b];
  }
  return !s.collided.empty();
}

/// Finds the pairs in the memory that a search around grains has added.
template <class Problem>
void find_more_saved(const ImpulseCache& memory, StepState<Problem>& s) {
  const auto found = s.detection.candidates();
  if (s.detection.added().empty()) return s.warm_starts.find(memory, found);
  std::vector<Candidate> added;
  for (const std::int32_t a : s.detection.added()) added.push_back(found[a]);
  s.warm_starts.find_added(memory, s.detection.added(), added);
}

/// The impacts of the step, on pairs in the order in which they are found.
template <class Problem>
void resolve_impacts(const StepInput& step, const MovingState& state, Stopwatch& watch, StepReport& report,
                     StepState<Problem>& s) {
  s.searched.x = s.free.x, s.searched.z = s.free.z;
  for (int searches = 1;; ++searches) {
    const auto loads = s.warm_starts.loads(state.memory, Problem::dim, step.time_step);
    const ImpactInput input{step, s.detection.candidates(), loads, s.contacts.wall_jumps};
    if (searches > 1 && !s.impacts.go_on(input)) return;
    s.impacts.resolve(input, {state.bodies, s.free.shift, s.contacts});
    if (s.energy) s.energy->add_impacts(s.impacts.collided(), s.impacts.work(), *state.energy);
    report.impacts += s.impacts.count();
    report.impacts_unresolved += s.impacts.unresolved();
    report.setup_seconds += watch.lap();
    if (s.impacts.count() == 0) return;
    move_freely(step, s);
    if (searches == most_searches || !find_collided(step, s)) return;
    if (s.detection.find_around(s.collided, step.bodies, s.free.x, s.free.z, detection_input(step)))
      find_more_saved(state.memory, s);
    report.detection_seconds += watch.lap();
  }
}

/// The pairs found, in the order of the solve, with the normals of the time at which they meet.
template <class Problem>
void take_candidates(const StepInput& step, StepState<Problem>& s) {
  const auto found = s.detection.candidates();
  const auto order = s.order.order();
  s.beside.assign(step.bodies.count(), 0);
  for (std::size_t a = 0; a < found.size(); ++a)
    if (const std::int32_t i = s.order.i()[a], j = s.order.j()[a]; j >= 0) s.beside[i] = s.beside[j] = 1;
  s.shifted.assign(step.bodies.count(), 0);
  for (std::size_t b = 0; b < s.free.shift.size(); ++b)
    s.shifted[b] = s.free.shift[b].x != 0 || s.free.shift[b].z != 0;
  resize_closely(s.contacts.pairs, found.size());
  s.loops().each(found.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) s.contacts.pairs[a] = found[order[a]];
    place_pairs(step, s.beside, s.shifted, std::span(s.contacts.pairs).subspan(begin, end - begin));
  });
}

template <class Problem>
void search(const StepInput& step, const MovingState& state, Stopwatch& watch, StepReport& report,
            StepState<Problem>& s) {
  const WorkMemory::Scope scope(&s.memory);
  s.contacts.impacts.clear();
  s.free.shift.clear();
  s.contacts.wall_jumps.assign(step.driven.size(), 0.0);
  move_freely(step, s);
  s.detection.find(step.bodies, s.free.x, s.free.z, detection_input(step));
  s.warm_starts.find(state.memory, s.detection.candidates());
  report.detection_seconds += watch.lap();
  if (step.laws.restitution) resolve_impacts(step, state, watch, report, s);
  // In solve order only now: impacts may have brought more pairs together.
  s.order.find(s.detection.candidates(), step.bodies, step.laws.period, s.problem.W.plan);
  take_candidates(step, s);
  s.warm_starts.warm_start(state.memory, Problem::dim, step.time_step, s.order.order(), s.solution.impulses);
  report.detection_seconds += watch.lap();
  turn_freely(step.laws, step.time_step, state.bodies);
  report.setup_seconds += watch.lap();
}

}  // namespace drumlin::particles
