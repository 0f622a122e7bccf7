#pragma once
// Keeps discs within containers and on their side of segments and arcs over a step, whatever moved them:
// their velocity, contacts that a solve left open, the position projection, or the wall itself.
//
// A thin wall pushes a disc towards the side on which its centre stands; a centre that ended a step beyond
// would be pushed on and out. The side is no memory: it is that at the beginning of the step, seen from the
// wall.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/box_tree.hpp"
#include "particles/bodies/period.hpp"
#include "particles/effects/wall_step.hpp"
#include "particles/parallel/parallel_loops.hpp"
#include "particles/stepping/lost_grain.hpp"

namespace drumlin::particles {

/// What became of the discs that crossed a wall.
struct Crossings {
  double deepest = 0;             ///< how deep one was in a wall, d; 0: none crossed
  std::optional<LostGrain> lost;  ///< the first that could not be laid back
};

/// Remembers where discs stand when a step begins.
class WallCrossings {
 public:
  /// Lets a pool share the work; the result does not depend on it.
  void use(ThreadPool* pool) { loops_ = ParallelLoops(pool); }
  /// The beginning of a step, before any disc is moved. `largest`: radius of the largest disc of all, where
  /// the bodies are a part of them; without, of the bodies.
  void begin(const Bodies&, std::span<const Shape> shapes, std::optional<double> largest = {});
  /// Lays each disc whose centre has crossed a segment or an arc since, between its ends, or a container,
  /// back onto the side that it came from; velocities stay. Lost is one that met such a wall which moves
  /// further than the disc's radius within the step, or for which there is no room. A disc that has moved
  /// further than the radius of the largest is left outside of a container (has_left()).
  Crossings undo(const WallStep&, const Period&, Bodies&);
  /// Boxes of thin walls that the last undo() looked at to find the discs that may have crossed one: what it
  /// cost.
  std::int64_t looked_at() const { return looked_at_; }

 private:
  void undo_at_containers(const WallStep&, const Period&, Bodies&, Crossings&) const;
  void undo_at_thin_walls(const WallStep&, const Period&, Bodies&, Crossings&);
  /// Lays disc b back from every thin wall that it crossed.
  void put_back(const WallStep&, const Period&, std::size_t b, Bodies&, Crossings&) const;

  ParallelLoops loops_;
  std::optional<double> largest_;
  std::vector<double> x_, z_;                   // centres at the beginning of the step
  std::vector<std::size_t> thin_, containers_;  // shapes; thin: segments and arcs
  std::vector<std::size_t> crossed_;
  double furthest_ = 0;  // that a disc has moved along an axis
  std::vector<Reaches> boxes_;
  BoxTree tree_;  // of the thin walls
  std::int64_t looked_at_ = 0;
};

}  // namespace drumlin::particles
