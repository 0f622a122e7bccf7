#pragma once
// What contacts remember from one step to the next, by identity (i, j): the warm start.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/detection/candidate.hpp"
#include "particles/parallel/team_loops.hpp"
#include "particles/parallel/work_memory.hpp"

namespace drumlin::particles {

/// Contacts of the last step, in the order of (i, j), in which pairs are found too.
struct ContactMemory {
  std::vector<std::int32_t> i, j;
  std::vector<double> impulse;  ///< dim per contact, normal first: the warm start
  double time_step = 0;         ///< the impulses belong to: they scale with it
};

/// Puts contacts that come from elsewhere in that order.
void put_in_order(ContactMemory&);

/// Whether a pair carried a load.
bool was_loaded(const ContactMemory&, const Candidate& pair);

/// Normal impulses that the pairs of a step carried in the last one; 0 of a new pair. Refers to a memory and
/// to a recollection of it.
class RememberedLoads {
 public:
  RememberedLoads() = default;
  RememberedLoads(std::span<const std::int32_t> place, std::span<const double> impulse, int dim, double scale)
      : place_(place), impulse_(impulse), dim_(dim), scale_(scale) {}
  double of(std::int32_t pair) const { return place_[pair] < 0 ? 0 : scale_ * impulse_[dim_ * place_[pair]]; }

 private:
  std::span<const std::int32_t> place_;
  std::span<const double> impulse_;
  int dim_ = 1;
  double scale_ = 1;
};

/// Finds contacts in a memory; keeps workspace only.
class Recollection {
 public:
  /// Lets a team share the work; the result does not depend on it.
  void use(ThreadTeam* team) { loops_ = TeamLoops(team); }
  /// Takes what it finds from a memory: it ends with the frame of find().
  void use(WorkMemory* memory) { place_.use(memory); }
  /// Finds pairs; those that follow one another in the order of (i, j) without a search.
  void find(const ContactMemory&, std::span<const Candidate> pairs);
  /// The same for the pairs of the last call and more of them, `pairs_added` at the positions `added`,
  /// ascending.
  void find_added(const ContactMemory&, std::span<const std::int32_t> added,
                  std::span<const Candidate> pairs_added);
  /// Normal impulses of the pairs that were looked for, for a step of length `time_step`.
  RememberedLoads loads(const ContactMemory&, int dim, double time_step) const;
  /// Impulses that a step of length `time_step` starts from: those remembered, 0 for new contacts. `order`:
  /// position of each among the pairs that were looked for.
  void warm_start(const ContactMemory&, int dim, double time_step, std::span<const std::int32_t> order,
                  std::vector<double>& impulses) const;

 private:
  TeamLoops loops_;
  WorkArray<std::int32_t> place_;  // of each pair that was looked for
};

/// Keeps the pairs (i, j) of a step, in order, and their impulses, of which `order` tells the positions
/// there.
void remember(std::span<const std::int32_t> i, std::span<const std::int32_t> j,
              std::span<const std::int32_t> order, const std::vector<double>& impulses, double time_step,
              const TeamLoops&, ContactMemory&);

}  // namespace drumlin::particles
