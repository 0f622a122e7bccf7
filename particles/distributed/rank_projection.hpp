#pragma once
// The end of a step on ranks: the overlap that is left, and its removal on positions alone.
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "particles/distributed/tile_solver.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/stepping/overlap.hpp"
#include "particles/stepping/position_projection.hpp"
#include "particles/stepping/projection_rule.hpp"

namespace drumlin::particles {

/// Contacts of a rank whose bodies have been moved.
struct MovedTiles {
  std::span<const Candidate> pairs;
  std::span<const TileRange> tiles;
  std::span<const double> impulses;  ///< dim per pair, normal first
  int dim = 1;
};

/// Looks at the contacts of a rank at the end of a step; keeps workspace only. The results are the same on
/// all ranks, but for the close pairs.
class RankOverlap {
 public:
  explicit RankOverlap(const Ranks& ranks) : ranks_(ranks) {}
  /// `lost` receives the first grain of this rank that left its container.
  Overlap find(const MovedTiles& contacts, const Bodies& bodies, const WallStep& walls, double margin,
               std::optional<LostGrain>& lost);
  std::span<const ClosePair> close() const { return pairs_; }
  /// Gives back what it holds of the pairs.
  void release() { free_memory_of(pairs_); }
  std::span<const TileRange> tiles() const { return tiles_; }
  /// Whether pairs overlap, on any rank.
  bool any() const { return any_; }

 private:
  Ranks ranks_;
  std::vector<ClosePair> pairs_;
  std::vector<TileRange> tiles_;
  bool any_ = false;
};

/// PositionProjection on ranks.
class RankProjection {
 public:
  RankProjection(const Ranks& ranks, ThreadTeam* team)
      : solver_(ranks, team, std::numeric_limits<std::int64_t>::max()) {}
  /// Returns the sweeps that it took.
  int apply(const RankOverlap& overlap, const TileOrder& order, std::span<const char> counts_here, Halo& halo,
            const ProjectionRule&, Bodies& bodies);
  /// Gives back its memory, until the next step.
  void release() { solver_.release(), problem_ = {}, solution_ = {}; }

 private:
  TileSolver<FrictionlessProblem> solver_;
  FrictionlessProblem problem_;
  Solution<FrictionlessProblem> solution_;
};

}  // namespace drumlin::particles
