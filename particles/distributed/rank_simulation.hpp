#pragma once
// A scene in time, on ranks. Knows no files.
#include <memory>
#include <vector>

#include "particles/distributed/rank_step.hpp"
#include "particles/distributed/ranks.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {

/// Members are called by all ranks together. The results do not depend on the number of ranks or threads.
class RankSimulation {
 public:
  /// `scene` is one that not_on_ranks() has no word against.
  RankSimulation(const Scene& scene, const Ranks& ranks, int threads);
  /// Continues from a state that Simulation accepts, whatever the number of ranks that left it.
  RankSimulation(const Scene& scene, SimulationState state, const Ranks& ranks, int threads);

  bool finished() const { return state_.step >= plan_.steps; }
  StepReport step();
  bool snapshot_due() const;
  /// The state after the last step; what the first rank gets counts, others get parts of it. Once in a step,
  /// and before release_memory(), which it calls.
  Snapshot take_snapshot();
  /// Everything that the next step depends on, gathered on the first rank; elsewhere without grains.
  SimulationState gathered_state() const;
  double kinetic_energy() const;
  /// Gives back what the next step makes anew, before much is gathered.
  void release_memory() { stepper_->release_memory(); }

  /// Grains, their memory and marks aside.
  const SimulationState& progress() const { return state_; }
  const TimePlan& plan() const { return plan_; }
  const Scales& scales() const { return scales_; }
  const RankCounts& counts() const { return stepper_->counts(); }

 private:
  void make_stepper(int threads, const Bodies& all);
  void take_own(const Bodies& all);
  void take_memory(const ContactMemory& memory, const Bodies& all);
  void enter_stage(int stage);
  void mark_positions();
  Bodies gathered_bodies() const;

  Scene scene_;
  Ranks ranks_;
  Scales scales_;
  TimePlan plan_;
  Walls walls_;
  SimulationState state_;  // without bodies and memory; marks on the first rank
  RankState own_;
  std::unique_ptr<RankStepper> stepper_;
};

}  // namespace drumlin::particles
