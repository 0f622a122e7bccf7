#pragma once
// Pairs of grains that touch or may touch within a step: near ones from grids, far ones from their speeds.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/detection/candidate.hpp"
#include "particles/detection/cell_grid.hpp"
#include "particles/detection/motion_tree.hpp"
#include "particles/detection/pair_weights.hpp"
#include "particles/parallel/parallel_loops.hpp"
#include "particles/parallel/work_memory.hpp"

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

/// What decides which pairs are kept: those with gap < margin + 2 h a + (bound_i + bound_j) / 2.
struct PairRule {
  double time_step = 0;
  double margin = 0;
  double speeds = 0;  ///< bound on the relative speed of any two grains
  Period period;
};

/// Lists pairs of grains that are near, which may be used again in later steps; looks for others that only
/// their speed brings together, and keeps those that may touch. Results depend neither on the age of the list
/// nor on the number of threads.
class GrainPairs {
 public:
  void use(ThreadPool* pool) { loops_ = ParallelLoops(pool); }
  /// Takes what a search needs beside the list from a memory, in a scope that lasts until keep().
  void use(WorkMemory* memory);

  /// Lists the pairs closer than `range`, as they are now, from grids that were sorted for it. The grids have
  /// to live as long as the list is used.
  void list(const GrainGrids& grids, const SearchedState& state, double range, const PairRule& rule);
  /// Looks at the listed pairs as they are now; the grids have followed the state.
  void weigh_again(const SearchedState& state, const PairRule& rule);

  /// Looks for pairs that are not listed and that only their speed brings together. bounds[i] becomes the
  /// largest 2 h a of body i with a partner closer than margin + 2 h a.
  void find_closing(const PairRule& rule, std::span<double> bounds);
  /// Looks further around bodies with bounds: an impact pushes them on to grains that they did not approach.
  void find_by_bounds(const PairRule& rule, std::span<const double> bounds);
  /// Writes the pairs that are kept, and those of walls, in the order of (i, j).
  void keep(const PairRule& rule, std::span<const double> bounds, std::span<const WeighedPair> walls,
            WorkArray<Candidate>& kept);

  /// Pairs of grains whose distance the last search measured: what it cost.
  std::int64_t distances() const { return distances_; }
  /// Those of them that are not in the list.
  std::int64_t far_distances() const { return far_distances_; }
  /// What the list holds from one search to the next.
  std::span<const ListedPair> listed_pairs() const { return list_; }
  std::size_t bytes() const;

 private:
  /// Cells [first, last) of a grid, and the pairs that they find; so few that threads share them evenly.
  struct Piece {
    std::size_t level = 0, first = 0, last = 0;
    std::vector<ListedPair> near;  // the first `count` of them
    std::size_t count = 0;
    std::int64_t distances = 0;
  };
  /// Some pairs of the list.
  struct Share {
    std::size_t first = 0, last = 0;
    std::size_t closing = 0, kept = 0;  // entries of closing_ and kept_ from `first` on
    std::size_t extras = 0, place = 0;  // the first pair that is not listed, and where the share's pairs go
    bool beyond = false;                // has pairs that are no closer than the range, by rounding
  };
  class Collecting;

  void cut(const GrainGrids& grids);
  void put_in_order(std::size_t bodies);
  void cut_list();
  void collect_discs(const SearchedState& state);
  void weigh_rest(std::span<const ListedPair> pairs, std::size_t done, const SearchedState& state,
                  double twice_step, PairWeight* weights) const;
  void weigh_list(const SearchedState& state, const PairRule& rule);
  void drop_those_beyond();
  template <class Work>
  void each_share(Work work);
  void find_closing_listed(const PairRule& rule, Share& share);
  void find_far(const PairRule& rule, std::span<const double> bounds, bool by_bounds);
  void find_extras(const PairRule& rule, std::span<const double> bounds, std::span<const WeighedPair> walls);

  ParallelLoops loops_;
  std::vector<Piece> pieces_;
  std::size_t used_ = 0;
  std::vector<ListedPair> list_;  // in the order of (i, j)
  double range_ = 0;              // within which pairs were listed
  std::vector<Share> shares_;
  // Of one search.
  WorkArray<std::int32_t> row_;    // first listed pair of each body
  WorkArray<PairWeight> weights_;  // of each listed pair
  WorkArray<std::int32_t> closing_,
      kept_;                     // listed pairs, share by share: those that close, those that are kept
  WorkArray<MovingDisc> discs_;  // the bodies, in the first period
  MotionTree tree_;
  bool planted_ = false, follows_ = false;  // the tree is that of the list; it bounds what is now
  const GrainGrids* grids_ = nullptr;       // of the list
  /// What a part of the tree's search finds.
  struct FarPart {
    std::vector<NearPair> pairs;
    std::int64_t distances = 0;
  };
  std::vector<FarPart> far_parts_;
  std::vector<NearPair> far_;
  std::vector<Candidate> extras_;  // kept pairs that are not listed, in the order of (i, j)
  std::int64_t distances_ = 0, far_distances_ = 0;
};

}  // namespace drumlin::particles
