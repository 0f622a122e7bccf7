#pragma once
// Solve order of contacts for parallel Gauss-Seidel sweeps: many contacts are solved side by side with the
// same result as one after the other.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/parallel/parallel_loops.hpp"
#include "particles/parallel/work_memory.hpp"

namespace drumlin::particles {

/// A sweep in two phases over strips.
///
/// Bodies are cut into slices, in such a way that a contact joins bodies of one slice or of two successive
/// ones; a contact belongs to the first of its slices. Two successive slices are a strip. In the first phase
/// all strips solve the contacts of their first slices, which touch bodies of their own strip only; in the
/// second phase those of their second slices, which touch the bodies of that slice and of the next one. So
/// within a phase no two strips touch the same body, and threads meet twice per sweep, whatever their number.
///
/// Within a slice, contacts stand in groups of one colour each: contacts of a group share no body, so that a
/// vector of them is solved at once. The fixed body that walls share is not counted.
struct SweepPlan {
  std::vector<std::int32_t> group_start;   ///< first contact of each group, and the number of contacts
  std::vector<std::int32_t> slice_start;   ///< first group of each slice, and the number of groups; slices
                                           ///< 2k and 2k + 1 are strip k
  std::vector<std::int32_t> body_order;    ///< bodies strip after strip; empty: not planned
  std::vector<std::int32_t> strip_bodies;  ///< first position in body_order of each strip, and the end

  bool empty() const { return strip_bodies.empty(); }
  int strips() const { return empty() ? 0 : static_cast<int>(strip_bodies.size()) - 1; }
};

/// Slice of each of `bodies` bodies for the pairs (i, j); j outside of [0, bodies) is fixed. Slices are
/// levels of a breadth-first search from a body at the rim, merged to about equal numbers of contacts.
std::vector<std::int32_t> body_slices(std::int32_t bodies, std::span<const std::int32_t> i,
                                      std::span<const std::int32_t> j);

/// The same from where bodies are along an axis: slices as thick as the longest pair, merged likewise. Takes
/// a tenth of the time of a search.
std::vector<std::int32_t> body_slices_along(std::span<const double> position, std::span<const std::int32_t> i,
                                            std::span<const std::int32_t> j);

/// Plans one set of contacts after the other; keeps work space only.
class SweepPlanner {
 public:
  /// Lets a pool share the work; the plan does not depend on it.
  void use(ThreadPool* pool) { loops_ = ParallelLoops(pool); }
  /// Takes work space from a memory, in the scope that is open when pairs are planned.
  void use(WorkMemory* memory) {
    slice_of_contact_.use(memory), by_slice_.use(memory), colour_.use(memory), used_.use(memory);
  }
  /// Plans the pairs (i, j) in given slices of bodies. `order` receives the pairs in solve order: slice by
  /// slice and greedy colour by colour, in the order given within a colour. False, and nothing planned, if
  /// the slices do not suit the pairs.
  bool plan(std::span<const std::int32_t> slice_of_body, std::span<const std::int32_t> i,
            std::span<const std::int32_t> j, SweepPlan& plan, std::vector<std::int32_t>& order);

 private:
  /// Groups of a slice, and the order of its contacts.
  void colour(int slice, std::span<const std::int32_t> i, std::span<const std::int32_t> j,
              std::span<std::int32_t> order);
  /// The same of contacts that are served at once, to positions from `first` on; returns the position after
  /// them.
  std::int32_t colour_round(std::span<const std::int32_t> served, std::int32_t first,
                            std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                            std::vector<std::int32_t>& groups, std::span<std::int32_t> order,
                            std::vector<std::int32_t>& left);

  ParallelLoops loops_;
  WorkArray<std::int32_t> slice_of_contact_, by_slice_;
  std::vector<std::int32_t> start_;
  std::vector<std::vector<std::int32_t>> groups_;  // of each slice
  WorkArray<std::int8_t> colour_;
  WorkArray<std::uint64_t> used_;  // colours of the contacts of each body, one bit each
};

/// Both at once, for a single problem that comes without positions.
SweepPlan sweep_plan(std::int32_t bodies, std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                     std::vector<std::int32_t>& order);

}  // namespace drumlin::particles
