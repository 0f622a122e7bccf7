#pragma once
// One implicit time step of rigid discs: Moreau-Jean (the paper, Sec. II, refs. Jean 1999, Moreau 1999) with
// theta = 1, predicted gaps, Newton restitution and a position projection that gives no kinetic energy.
//
// Departures from the paper: contacts may act before they touch, u_n >= -g/h for a gap g > 0 (contacts that
// act only when touching crush the packing at h = 6e-3 s); the approach speed of a pair that is so slowed to
// just touching is remembered and restored, times e, in the next step; what overlap remains is projected away
// on positions alone.
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/contact/problems.hpp"
#include "particles/detection/contact_list.hpp"
#include "particles/effects/pair_law.hpp"
#include "particles/measurement/snapshot.hpp"
#include "particles/solver/contact_solver.hpp"
#include "particles/stepping/contact_memory.hpp"
#include "particles/stepping/energy_ledger.hpp"
#include "particles/stepping/lost_grain.hpp"

namespace drumlin {

/// Dimensionless laws of a scene. An effect that the scene does not name is an empty optional.
struct StepLaws {
  struct RestitutionLaw {
    PairLaw e;
    double gravity = 0;  ///< impacts slower than 2 gravity h are at rest: a grain that lies arrives at
                         ///< gravity h every step
  };
  struct CohesionLaw {
    PairLaw force;
    double range = 0;  ///< pairs with a smaller gap attract each other
  };
  struct Acceleration {
    double x = 0, z = 0;
  };
  std::optional<Acceleration> gravity;
  std::optional<PairLaw> friction;
  std::optional<RestitutionLaw> restitution;
  std::optional<CohesionLaw> cohesion;
  bool spin = false;
  std::optional<PairLaw> rolling;
  bool energy_ledger = false;
  bool driven_walls = false;  ///< whether contacts move a wall in some stage
  Period period;
  std::vector<std::uint8_t> material_of_shape;  ///< empty when no law asks for it
  double detection_margin = 0.02;               ///< d; pairs closer than this are always candidates
};

struct StepSolver {
  std::string name;
  StoppingRule rule;
  int projection_sweeps = 0;
  int threads = 1;
};

/// Overlap of loaded contacts before the position projection, in d.
struct Overlap {
  double mean = 0, max = 0;
  int loaded = 0;
};

struct StepReport {
  SolveReport solve;
  Overlap overlap;
  std::optional<LostGrain> lost;  ///< the step went wrong: its state must not be built upon
  int contacts = 0;
  double detection_seconds = 0, setup_seconds = 0, projection_seconds = 0;
};

/// A wall that contacts push, over one step.
struct DrivenStep {
  Point direction;
  double inverse_mass = 0;
  double velocity_before = 0;
  double velocity = 0;  ///< along the direction at the end: without contacts, until the step is done
};

/// Walls over one step: shapes at its beginning and end, and the displacement of each in between. Where
/// contacts push walls, `after` is where they would be without, until the step is done.
struct WallStep {
  std::vector<Shape> before, after;
  std::vector<Pose> displacement;
  std::vector<DrivenStep> driven = {};             ///< of the current stage, in the order of the walls
  std::vector<std::int32_t> driven_of_shape = {};  ///< -1: not driven; empty if no shape is
};
WallStep wall_step(const Walls& walls, double time_in_stage, double time_step);

/// Does steps for one combination of effects; holds work space only, no state.
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// `walls` is changed only where contacts push a wall, `energy` only if the laws ask for a ledger.
  virtual StepReport advance(Bodies& bodies, ContactMemory& memory, WallStep& walls, double time_step,
                             std::optional<EnergyLedger>& energy) = 0;
  /// Loaded contacts of the last step, with the normals that it used.
  virtual std::vector<SnapshotContact> loaded_contacts() const = 0;
  /// The contact problem of the last step, as it travels in files; none where a contact has more unknowns or
  /// couples than a file can hold (rolling resistance, walls moved by a force).
  virtual std::optional<BlockProblem> last_problem() const = 0;
  /// Unknowns per contact and numbers of velocity per body: what the effects of the scene cost.
  virtual int unknowns_per_contact() const = 0;
  virtual int velocities_per_body() const = 0;
};

/// The laws of a scene, dimensionless.
StepLaws laws_of(const Scene& scene, const Scales& scales);

/// The stepper for the effects that are named in `laws`: the one place where they become types.
std::unique_ptr<Stepper> make_stepper(const StepLaws& laws, const StepSolver& solver);

}  // namespace drumlin
