#pragma once
// A scene in time: stages, wall motions, steps, snapshots. Knows no files.
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "particles/bodies/snapshot.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/contact/contact_places.hpp"
#include "particles/scene/scene.hpp"
#include "particles/scene/scene_walls.hpp"
#include "particles/stepping/events.hpp"
#include "particles/stepping/moreau_jean.hpp"
#include "particles/stepping/start_check.hpp"

namespace drumlin::particles {

Scales scales_of(const Scene& scene);

class Simulation {
 public:
  /// Validates nothing but what only shows when grains are placed (InputError): listed grains that overlap by
  /// more than most_at_start are among it.
  /// The results do not depend on the number of threads, nor on that of ranks, which all take the same steps.
  explicit Simulation(const Scene& scene, int threads = 1, World* world = nullptr);
  /// Continues from a state. Throws InputError when it does not fit the scene.
  Simulation(const Scene& scene, SimulationState state, int threads = 1, World* world = nullptr);
  ~Simulation();

  bool finished() const { return state_.step >= plan_.steps; }
  /// One step; must not be finished.
  StepReport step();

  // What a caller changes between two steps. A continued run knows it: of scene() and state() it is the same.
  /// The stage of the next step.
  int next_stage() const;
  /// Takes over from the next step on what `changed` says of its stage: length, gravity, coefficients,
  /// motions and cell. `moved`: the wall whose motions are others, which goes on from where it is. Throws
  /// InputError where the stage depends on how that wall moves.
  void change_stage(const Stage& changed, const std::string& moved = "");
  /// Gives the grains other velocities, one for each. Throws InputError where one is not finite or faster
  /// than steps can follow, and in a scene with an energy ledger, which has no account for it.
  void set_velocities(std::span<const double> v_x, std::span<const double> v_z, std::span<const double> spin);

  /// Whether a snapshot belongs to the state after the last step.
  bool snapshot_due() const;
  /// The state after the last step. Counts as the next snapshot of the run.
  Snapshot take_snapshot();
  /// Whether an interval of loads on walls is over after the last step.
  bool wall_loads_due() const;
  /// The loads on walls since the last call, or the start; the next step begins another interval.
  WallLoads take_wall_loads();
  /// Loaded contacts of the last step, with the normals that it used, as the scene tells them.
  std::vector<SnapshotContact> last_contacts() const;
  /// The time step of the last step: impulse / time step is a force.
  double last_time_step() const { return plan_.stages[state_.stage].time_step; }
  /// Where the contacts of the last step's problem are after it, with the normals that it used.
  ContactPlaces last_places() const;

  const Scene& scene() const { return scene_; }
  const SimulationState& state() const { return state_; }
  const TimePlan& plan() const { return plan_; }
  const Scales& scales() const { return scales_; }
  const Walls& walls() const { return setting_.walls; }
  const Stepper& stepper() const { return *stepper_; }
  /// Gives back what the next step can do without: before output takes memory of its own.
  void release_memory() { stepper_->release_memory(); }
  /// Overlaps of listed grains at the start; none of generated ones, nor where a state goes on.
  const StartOverlaps& start_overlaps() const { return start_overlaps_; }

 private:
  /// What all begin with; nothing is placed nor checked.
  Simulation(SimulationState state, const Scene& scene, int threads, World* world);
  /// What an event sees of the next step.
  EventInput event_input();
  /// Applies those events that count for the stage.
  void apply_events(bool each_step);
  /// Makes setting and events of scene and state; returns how its driven walls begin the stage.
  std::vector<DrivenState> make_setting();
  void enter_next_stage();
  StepReport advance_here(double time_step);
  StepReport advance_in_laboratory(double time_step);
  MovingCell begin_cell_step(double time_step);
  void end_cell_step(const CellState& begun, double time_step);
  void mark_positions();
  void count_left();
  void add_wall_loads(double time_step);
  void end_stage_if_due();
  /// A normal of the last step, as the scene tells it.
  Point normal_in_scene(double n_x, double n_z) const;

  Scene scene_;
  Scales scales_;
  TimePlan plan_;
  Setting setting_;
  std::vector<Event> events_;
  Extent extent_;  ///< of the scene at its start
  SimulationState state_;
  StartOverlaps start_overlaps_;
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace drumlin::particles
