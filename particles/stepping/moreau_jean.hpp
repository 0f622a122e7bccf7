#pragma once
// One time step of rigid discs: implicit contacts by Moreau-Jean (the paper, Sec. II, refs. Jean 1999, Moreau
// 1999) with theta = 1, predicted gaps, impacts at their times and a position projection that gives no
// kinetic energy. Grains in flight take the mean velocity of the step, which is exact, and grains that touch
// one wall and nothing else the midpoint rule (lone_contact.hpp). Pairs that contacts bring together are
// taken in, and the step is solved again (step_end.hpp).
//
// Departures from the paper: contacts may act before they touch, u_n >= -g/h for a gap g > 0 (contacts that
// act only when touching crush the packing at h = 6e-3 s), and without restitution; pairs that meet fast
// rebound before, at the time at which they meet (impacts.hpp); what overlap remains is projected away on
// positions alone.
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/snapshot.hpp"
#include "particles/contact/problem_kinds.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/moving_cell.hpp"
#include "particles/effects/wall_step.hpp"
#include "particles/parallel/world.hpp"
#include "particles/solver/solver_names.hpp"
#include "particles/solver/stopping_rule.hpp"
#include "particles/stepping/energy_ledger.hpp"
#include "particles/stepping/impulse_cache.hpp"
#include "particles/stepping/lost_grain.hpp"
#include "particles/stepping/overlap.hpp"
#include "particles/stepping/projection_rule.hpp"
#include "particles/stepping/step_laws.hpp"
#include "particles/stepping/wall_loads.hpp"

namespace drumlin::particles {

struct StepSolver {
  std::string name;
  StoppingRule rule;
  ProjectionRule projection;
  int threads = 1;
  World* world = nullptr;  ///< of the ranks that take the steps together; none: this process alone
};

struct StepReport {
  SolveReport solve;
  Overlap overlap;
  std::optional<LostGrain> lost;  ///< the step went wrong: its state must not be built upon
  std::int64_t contacts = 0;
  int impacts = 0;             ///< pairs that met fast enough and rebounded; 0 without restitution
  int impacts_unresolved = 0;  ///< pairs that met more often within the step than is followed
  double detection_seconds = 0, setup_seconds = 0, projection_seconds = 0;
};

/// Everything that a step changes and the next one needs.
struct MovingState {
  StepLaws& laws;  ///< the effects are always the same ones; of a moving cell the period changes
  Bodies& bodies;
  ImpulseCache& memory;
  std::span<DrivenState> driven;        ///< in the order of WallStep::driven
  std::optional<EnergyLedger>& energy;  ///< changed only if the laws ask for a ledger
  std::optional<MovingCell> cell = {};
};

/// Bytes of what a stepper holds, used or not.
struct StepMemory {
  std::size_t kept = 0;    ///< from step to step: pairs, lists, the contact problem and its solution
  std::size_t shared = 0;  ///< by the phases of a step, one after the other
};

/// Does steps for one combination of effects; holds workspace only, no state.
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// `walls` is changed only where contacts push a wall.
  virtual StepReport advance(const MovingState& state, WallStep& walls, double time_step) = 0;
  /// What walls gave grains in the last step, impacts among it.
  virtual std::vector<WallContact> wall_contacts() const = 0;
  /// Loaded contacts of the last step, with the normals that it used.
  virtual std::vector<SnapshotContact> loaded_contacts() const = 0;
  /// The contact problem of the last step, until the next one.
  virtual DiscProblem last_problem() const = 0;
  /// Its pairs, in the order of its contacts.
  virtual std::span<const Candidate> last_pairs() const = 0;
  /// Gives back what no other step needs to have kept, until the next one.
  virtual void release_memory() = 0;
  virtual StepMemory memory() const = 0;
  /// Unknowns per contact and numbers of velocity per body: what the effects of the scene cost.
  virtual int unknowns_per_contact() const = 0;
  virtual int velocities_per_body() const = 0;
};

/// The stepper for the effects that are named in `laws`: the one place where they become types.
std::unique_ptr<Stepper> make_stepper(const StepLaws& laws, const StepSolver& solver);
/// The same with solvers that the caller brings, whatever the name.
std::unique_ptr<Stepper> make_stepper(const StepLaws& laws, const StepSolver& solver,
                                      const ContactSolvers& solvers);

}  // namespace drumlin::particles
