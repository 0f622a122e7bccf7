#pragma once
// A scene in time, on ranks. Knows no files.
#include <cstdint>
#include <memory>
#include <span>
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
  /// This rank's part of the state after the last step: grains of identities in a row, and the contacts of
  /// which they are the first; all else is the same on all ranks. With fewer grains than ranks the first has
  /// all. Once in a step, and before release_memory(), which it calls.
  Snapshot take_part_of_snapshot();
  /// This rank's part of everything that the next step depends on: bodies of identities in a row, and the
  /// memory of the contacts of which they are the first; marks on the first rank alone, all else everywhere.
  SimulationState part_of_state() const;
  /// Whether each rank has a part with grains.
  bool all_have_parts() const { return grains_ >= ranks_.count(); }
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
  Bodies empty_bodies(std::size_t grains) const;
  void put(const RankGrain& grain, std::int64_t first, Bodies& bodies) const;
  Bodies gathered_bodies() const;
  /// Of what is sorted by identities each rank has one part, from its first identity to that of the next
  /// rank.
  std::int64_t first_of_part(int rank) const;
  std::size_t part_of(std::int64_t id) const;
  template <class Item, class Id>
  std::vector<std::vector<Item>> to_parts(std::span<const Item> items, Id id_of) const;
  Bodies bodies_of_part() const;
  std::vector<SnapshotContact> contacts_of_part();
  /// The marks for this snapshot, taken from those of the first rank.
  decltype(SimulationState::marks) marks_of_part();
  ContactMemory memory_of(const std::vector<RememberedContact>& in_order) const;

  Scene scene_;
  Ranks ranks_;
  Scales scales_;
  TimePlan plan_;
  Walls walls_;
  SimulationState state_;    // without bodies and memory; marks on the first rank
  std::int64_t grains_ = 0;  // of all ranks
  RankState own_;
  std::unique_ptr<RankStepper> stepper_;
};

}  // namespace drumlin::particles
