#pragma once
// Overlap at the end of a step, and the pairs between which the position projection removes it.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/period.hpp"
#include "particles/contact/sweep_plan.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/wall_step.hpp"
#include "particles/parallel/parallel_loops.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/stepping/lost_grain.hpp"
#include "particles/stepping/position_projection.hpp"

namespace drumlin::particles {

/// Overlap of loaded contacts before the position projection, in d.
struct Overlap {
  double mean = 0, max = 0;
  std::int64_t loaded = 0;
  std::int64_t grain = -1, other = -1;  ///< of the deepest, by their ids where grains have any; < 0: a wall
  double x = 0, z = 0;                  ///< centre of the grain
};

/// What pieces of the pairs add to it.
struct OverlapSums {
  double depths = 0, deepest = 0;
  std::int32_t i = -1, j = -1;  ///< the deepest pair
  std::int64_t loaded = 0;
  std::int32_t close = 0;  ///< pairs closer than the margin
  bool overlap = false;    ///< one of those has a negative gap
  std::optional<LostGrain> lost;
};

/// Contacts of a step that has been solved and whose bodies have been moved.
struct MovedContacts {
  std::span<const Candidate> pairs;
  PairBodies bodies;
  std::span<const double> impulses;  ///< dim per pair, normal first
  int dim = 1;
  const SweepPlan& plan;  ///< of the pairs
};

/// Looks at all pairs once more, at the end of the step; keeps workspace only.
class OverlapSearch {
 public:
  /// Lets a pool share the work; the result does not depend on it.
  void use(ThreadPool* pool) { loops_ = ParallelLoops(pool); }
  /// Takes the pairs from a memory: they end with the scope of find().
  void use(WorkMemory* memory) { pairs_.use(memory); }

  /// Overlap of the loaded contacts. `lost` receives the first grain that left its container.
  Overlap find(const MovedContacts& contacts, const Bodies& bodies, const WallStep& walls,
               const Period& period, double margin, std::optional<LostGrain>& lost);

  /// Pairs closer than `margin` in the last search, and their plan.
  ClosePairs close() const { return {{pairs_.data(), pairs_.size()}, earlier_, overlap_}; }
  const SweepPlan& plan() const { return plan_; }

 private:
  /// Pairs `begin` to `end`, those of one piece.
  OverlapSums overlaps_among(std::size_t begin, std::size_t end, const MovedContacts& contacts,
                             const Bodies& bodies, const WallStep& walls, const Period& period,
                             double margin);

  ParallelLoops loops_;
  WorkArray<ClosePair> pairs_;         // ClosePairs::places
  std::vector<std::int32_t> earlier_;  // ClosePairs::earlier
  std::vector<OverlapSums> sums_;      // of each piece
  bool overlap_ = false;
  SweepPlan plan_;
};

}  // namespace drumlin::particles
