#pragma once
// What the phases of a step work on. All of it is memory that is kept from step to step, and no result of a
// step but the last contacts: step_search.hpp, step_solve.hpp, lone_steps.hpp and step_motion.hpp write it
// one after the other.
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "particles/detection/contact_list.hpp"
#include "particles/detection/contact_order.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/solver/contact_solver.hpp"
#include "particles/stepping/impacts.hpp"
#include "particles/stepping/moreau_jean.hpp"
#include "particles/stepping/position_projection.hpp"
#include "particles/stepping/step_end.hpp"
#include "particles/stepping/stopwatch.hpp"
#include "particles/stepping/wall_crossing.hpp"

namespace drumlin::particles {

template <class Problem>
struct StepState {
  static constexpr bool spin = Problem::Delassus::spin;

  StepState(const StepLaws& laws, const StepSolver& of_step) : solver(of_step), pool(of_step.threads) {
    work.pool = &pool, work.memory = &memory, work.world = solver.world;
    projection.use(solver.world);
    const auto share = [this](auto&... users) {
      (users.use(&pool), ...);
      (users.use(&memory), ...);
    };
    share(detection, warm_starts, impacts, order, overlaps, projection);
    crossings.use(&pool);
    if (laws.energy_ledger) energy.emplace(laws.gravity);
  }

  ParallelLoops loops() { return ParallelLoops(&pool); }
  PairBodies pair_bodies() const { return {problem.W.i, problem.W.j, problem.W.fixed()}; }
  StepEnd end_of(const StepInput& step) const {
    const auto& changes = solution.velocities.bodies;
    return {step, problem.contacts() > 0 ? std::span<const BodyVelocity>(changes)
                                         : std::span<const BodyVelocity>()};
  }
  StepMemory bytes() const {
    const auto& W = problem.W;
    const std::size_t of_problem = bytes_of(W.i) + bytes_of(W.j) + bytes_of(W.n_x) + bytes_of(W.n_z) +
                                   bytes_of(W.inverse_mass) + bytes_of(problem.q) + bytes_of(problem.mu);
    const std::size_t of_solution = bytes_of(solution.impulses) + bytes_of(solution.velocities.bodies) +
                                    bytes_of(solution.velocities.contacts);
    const std::size_t grains =
        bytes_of(free.x) + bytes_of(free.z) + bytes_of(searched.x) + bytes_of(searched.z);
    return {detection.bytes() + bytes_of(contacts.pairs) + order.bytes() + of_problem + of_solution + grains +
                projection.bytes(),
            memory.bytes()};
  }

  StepSolver solver;
  ThreadPool pool;
  WorkMemory memory;  ///< of one phase of a step after the other
  // The search.
  FreeMotion free;
  FreeMotion searched;                 ///< velocities by which pairs were last looked for, grain by grain
  std::vector<CollidedDisc> collided;  ///< since then
  std::vector<char> beside;            ///< of each grain: it has a pair with another
  std::vector<char> shifted;           ///< of each grain: an impact moved the beginning of its path
  ContactDetection detection;
  ContactOrder order;
  StepContacts contacts;
  Impacts impacts;
  WarmStarts warm_starts;
  // The solve.
  Problem problem;
  SolverWorkspace<Problem> work;
  Solution<Problem> solution;
  MissedPairs missed;
  // The motion.
  std::vector<std::pair<std::int32_t, Point>> lone;  ///< grains on one wall, and where their step ends
  std::vector<char> flies;                           ///< of each grain: no contact acts
  OverlapSearch overlaps;
  PositionProjection projection;
  WallCrossings crossings;
  std::optional<StepEnergy> energy;  ///< only with an energy ledger
};

}  // namespace drumlin::particles
