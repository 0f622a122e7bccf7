#pragma once
// The grains that a rank sees in a step, and the impulses that it remembers for them: the forest suited to
// the step, and what it took to bring everything to the rank that needs it.
#include <memory>
#include <vector>

#include "particles/distributed/forest.hpp"
#include "particles/distributed/rank_step.hpp"
#include "particles/distributed/step_pairs.hpp"
#include "particles/effects/wall_step.hpp"
#include "particles/stepping/contact_memory.hpp"
#include "particles/stepping/step_laws.hpp"

namespace drumlin::particles {

class RankGrains {
 public:
  RankGrains(const Ranks& ranks, const Domain& domain, bool with_spin, int unknowns, double margin)
      : ranks_(ranks), domain_(domain), with_spin_(with_spin), unknowns_(unknowns), margin_(margin) {}

  /// Brings grains and memory to the ranks that own their tiles, and ghosts to those that see them. `gain`:
  /// what forces add to velocities within the step.
  void settle(RankState& state, const WallStep& walls, double time_step, Point gain);
  /// The same once velocities have changed, where they need larger cells; false if they do not.
  bool settle_again(RankState& state, const WallStep& walls, double time_step, Point gain);

  SeenGrains& seen() { return seen_; }
  const TileMap& tiles() const { return forest_->tiles(); }
  std::size_t ghosts() const { return forest_->ghosts().size(); }
  std::int64_t forests() const { return forests_; }
  /// Place of a grain among those seen; -1: not seen.
  std::int32_t place_of(std::int64_t id) const { return place_of_[id]; }
  /// The same of all identities.
  std::span<const std::int32_t> places() const { return place_of_; }
  /// What is remembered of pairs of seen grains, with their places.
  const ContactMemory& memory() const { return memory_; }

 private:
  Reach reach_of(const RankState&, const WallStep&, double time_step, Point gain) const;
  void build(RankState&, const TileGrid&);
  bool unbalanced() const;
  void see(const RankState&);
  void bring_memory(RankState&);
  void refuse(const GrainOutside&) const;

  Ranks ranks_;
  Domain domain_;
  bool with_spin_;
  int unknowns_;  // per contact
  double margin_;
  std::unique_ptr<Forest> forest_;
  SeenGrains seen_;
  std::vector<std::int32_t> place_of_;
  ContactMemory memory_;
  std::int64_t forests_ = 0, steps_ = 0;  // steps since the forest was made
};

}  // namespace drumlin::particles
