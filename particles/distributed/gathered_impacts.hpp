#pragma once
// Impacts of a step on ranks. The first rank resolves them for all, since passes of all impacts are one
// computation; it gets the pairs that passes may reach and no others. A step in which no pair closes fast
// enough gathers nothing.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/distributed/ranks.hpp"
#include "particles/stepping/impacts.hpp"
#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// New velocities of a grain that impacts have struck, and what they were before.
struct StruckRecord {
  std::int64_t id = 0;
  double v_x = 0, v_z = 0, spin = 0;
  Point before;
};

/// The part of one rank in the impacts of a step.
struct RankImpacts {
  const StepInput& step;  ///< its bodies are the grains that the rank sees, by ascending identity
  const RememberedLoads& loads;
  Bodies& bodies;                          ///< those of the step: one rank alone sets their velocities
  StepContacts& contacts;                  ///< pairs of the rank's tiles, in the order of (i, j)
  std::span<const Candidate> candidates;   ///< all pairs of the grains that it sees
  std::span<const std::int32_t> place_of;  ///< of each identity among the bodies; -1: not seen
};

/// What impacts have sent to the first rank since the program began, from this rank.
struct GatheredCounts {
  std::int64_t times = 0;  ///< that anything was gathered
  std::int64_t rounds = 0;
  std::int64_t pairs = 0, bytes = 0;
};

class GatheredImpacts {
 public:
  explicit GatheredImpacts(const Ranks& ranks) : ranks_(ranks) {}

  /// Resolves the impacts among the pairs of all ranks; the result is that of one process, to the last bit.
  /// All ranks call it together and get the grains that were struck. `mine.step.laws` asks for restitution.
  std::vector<StruckRecord> resolve(const RankImpacts& mine);
  /// Pairs that met in the last call, counted once per pass.
  int count() const { return count_; }
  /// On the first rank: impulses since the last clear(), with identities in place of indices.
  const std::vector<Strike>& strikes() const { return strikes_; }
  void clear() { strikes_.clear(); }
  const GatheredCounts& counts() const { return counts_; }

 private:
  /// A pair as it travels, with identities; j < 0 is a wall shape.
  struct PairRecord {
    std::int32_t i = 0, j = 0;
    double gap = 0, n_x = 0, n_z = 0, wall_v_x = 0, wall_v_z = 0, load = 0;
  };
  /// What impacts ask of a grain.
  struct BodyRecord {
    std::int32_t id = 0;
    double v_x = 0, v_z = 0, spin = 0, radius = 0, inverse_mass = 0;
  };

  std::vector<StruckRecord> resolve_alone(const RankImpacts& mine);
  /// Finds which candidates join each seen body to which others.
  void find_neighbours(const RankImpacts& mine);
  /// Marks the seeds and all bodies within so many pairs of them; returns the identities of the marked.
  std::vector<std::int32_t> around(const RankImpacts& mine, int pairs);
  /// Adds the pairs of wanted bodies to what the first rank holds.
  void send(const RankImpacts& mine);
  /// Adds to the bodies whose pairs the first rank needs, and marks those that this rank sees.
  void want(const RankImpacts& mine, std::span<const std::int32_t> identities);
  /// On the first rank; nothing changes where missing_ bodies came in. `all`: it holds all pairs.
  void resolve_gathered(const StepInput& step, bool all, std::vector<StruckRecord>& struck);

  Ranks ranks_;
  Impacts looked_, impacts_;
  std::vector<char> seed_;                              // of each seen body
  std::vector<std::int32_t> first_, neighbour_, ring_;  // neighbours of b from first_[b] on
  std::vector<char> wanted_;                            // of each seen body: all pairs of it are to be sent
  std::vector<char> pair_sent_, sent_;                  // of each pair of this rank; of each seen body
  std::vector<char> whole_;                             // on the first rank, of each identity: wanted
  std::vector<PairRecord> pairs_;       // those that the first rank holds, in the order of (i, j)
  std::vector<BodyRecord> bodies_;      // by identity
  std::vector<std::int32_t> place_of_;  // of each identity among them; others are not set
  std::vector<std::int32_t> missing_;   // identities
  std::vector<Strike> strikes_;
  GatheredCounts counts_;
  int count_ = 0;
};

}  // namespace drumlin::particles
