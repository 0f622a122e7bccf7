#pragma once
// Pairs of grains that touch or may touch within a step: near ones from grids, far ones from their speeds.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/detection/candidate.hpp"
#include "particles/detection/cell_grid.hpp"
#include "particles/detection/motion_tree.hpp"
#include "particles/parallel/team_loops.hpp"

namespace drumlin::particles {

/// A pair and how far it may close, twice over, by its own approach: 2 h a.
struct WeighedPair {
  Candidate pair;
  double reach = 0;
};

/// A pair of grains, i < j, as a search sees it: its gap, its normal from j to i, and how far it may close,
/// twice over: 2 h a.
struct NearPair {
  std::int32_t i, j;
  double gap, n_x, n_z;
  double reach;
};
/// The pair of a and b, or of the images that are nearest.
NearPair near_pair(const NearGrain& a, const NearGrain& b, const Period& period, double time_step);

/// What decides which pairs are kept: those with gap < margin + 2 h a + (jolt_i + jolt_j) / 2.
struct PairRule {
  double time_step = 0;
  double margin = 0;
  double speeds = 0;  ///< bound on the relative speed of any two grains
  double range = 0;   ///< pairs closer than this are looked for in grids; no result depends on it
  Period period;
};

/// Looks for pairs of grains and keeps those that may touch. Keeps work space only; results do not depend on
/// the number of threads.
class GrainPairs {
 public:
  void use(ThreadTeam* team) { loops_ = TeamLoops(team); }

  /// Looks at the pairs closer than rule.range, with grids sorted for it, and at those that only their speed
  /// brings together. jolts[i] becomes the largest 2 h a of body i with a partner closer than margin + 2 h a.
  void look(const GrainGrids& grids, const PairRule& rule, std::span<double> jolts);
  /// Looks further around bodies with jolts: an impact pushes them on to grains that they did not approach.
  void look_after_jolts(const PairRule& rule, std::span<const double> jolts);
  /// Writes the pairs that are kept, and those of walls, in the order of (i, j).
  void keep(const PairRule& rule, std::span<const double> jolts, std::span<const WeighedPair> walls,
            std::vector<Candidate>& kept);

  /// Pairs of grains whose distance the last search measured: what it costs.
  std::int64_t looked_at() const { return looked_at_; }

 private:
  struct Jolt {
    std::int32_t i, j;
    double reach;
  };
  /// A pair that is kept, and where it is: in a piece, or (-1) among the walls' pairs.
  struct Slot {
    std::int32_t i, j;
    std::int32_t piece, place;
  };
  /// Cells [first, last) of a grid, and the pairs that they find; so few that threads share them evenly.
  struct Piece {
    std::size_t level = 0, first = 0, last = 0;
    std::vector<NearPair> near;  // the first `count` of them
    std::size_t count = 0;
    std::vector<Slot> kept;
    std::vector<Jolt> jolts;
    std::int64_t looked_at = 0;
  };
  class Weighing;

  void cut(const GrainGrids& grids);
  void look_far(const PairRule& rule, std::span<const double> jolts, bool after_jolts);
  void add_jolts(const Piece& piece, std::span<double> jolts) const;
  void place(const PairRule& rule, std::span<const double> jolts, std::span<const WeighedPair> walls);

  TeamLoops loops_;
  std::vector<Piece> pieces_;  // the first is of far pairs, the others are of cells
  std::size_t used_ = 0;
  MotionTree tree_;
  const GrainGrids* grids_ = nullptr;  // of the search that is under way
  bool planted_ = false;               // the tree is that of this search
  std::int64_t looked_at_ = 0;
  std::vector<std::int32_t> row_;  // first slot of each body
  std::vector<Slot> kept_walls_, slots_;
};

}  // namespace drumlin::particles
