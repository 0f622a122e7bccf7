#pragma once
// What contacts remember from one step to the next, by identity (i, j): the warm start.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/detection/candidate.hpp"
#include "particles/parallel/parallel_loops.hpp"
#include "particles/parallel/work_memory.hpp"

namespace drumlin::particles {

/// Contacts of the last step, in the order of (i, j), in which pairs are found too.
struct ImpulseCache {
  std::vector<std::int32_t> i, j;
  std::vector<double> impulse;  ///< dim per contact, normal first: the warm start
  double time_step = 0;         ///< the impulses belong to: they scale with it
};

/// Puts contacts that come from elsewhere in that order.
void put_in_order(ImpulseCache&);

/// Whether a pair carried a load.
bool was_loaded(const ImpulseCache&, const Candidate& pair);

/// Normal impulses that the pairs of a step carried in the last one; 0 of a new pair. Refers to a cache and
/// to the WarmStarts that looked in it.
class SavedLoads {
 public:
  SavedLoads() = default;
  SavedLoads(std::span<const std::int32_t> place, std::span<const double> impulse, int dim, double scale)
      : place_(place), impulse_(impulse), dim_(dim), scale_(scale) {}
  double of(std::int32_t pair) const { return place_[pair] < 0 ? 0 : scale_ * impulse_[dim_ * place_[pair]]; }

 private:
  std::span<const std::int32_t> place_;
  std::span<const double> impulse_;
  int dim_ = 1;
  double scale_ = 1;
};

/// Finds contacts in a cache; keeps workspace only.
class WarmStarts {
 public:
  /// Lets a pool share the work; the result does not depend on it.
  void use(ThreadPool* pool) { loops_ = ParallelLoops(pool); }
  /// Takes what it finds from a memory: it ends with the scope of find().
  void use(WorkMemory* memory) { place_.use(memory); }
  /// Finds pairs; those that follow one another in the order of (i, j) without a search.
  void find(const ImpulseCache&, std::span<const Candidate> pairs);
  /// The same for the pairs of the last call and more of them, `pairs_added` at the positions `added`,
  /// ascending.
  void find_added(const ImpulseCache&, std::span<const std::int32_t> added,
                  std::span<const Candidate> pairs_added);
  /// Normal impulses of the pairs that were looked for, for a step of length `time_step`.
  SavedLoads loads(const ImpulseCache&, int dim, double time_step) const;
  /// Impulses that a step of length `time_step` starts from: those remembered, 0 for new contacts. `order`:
  /// position of each among the pairs that were looked for.
  void warm_start(const ImpulseCache&, int dim, double time_step, std::span<const std::int32_t> order,
                  std::vector<double>& impulses) const;

 private:
  ParallelLoops loops_;
  WorkArray<std::int32_t> place_;  // of each pair that was looked for
};

/// Keeps the pairs (i, j) of a step, in order, and their impulses, of which `order` tells the positions
/// there.
void save_contacts(std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                   std::span<const std::int32_t> order, const std::vector<double>& impulses, double time_step,
                   const ParallelLoops&, ImpulseCache&);

}  // namespace drumlin::particles
