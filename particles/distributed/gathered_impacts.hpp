#pragma once
// Impacts of a step on ranks. One rank resolves them for all, since passes of all impacts are one
// computation: the one on which most pairs close. It gets the pairs that passes may reach and no others. A
// step in which no pair closes fast enough gathers nothing.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/distributed/near_places.hpp"
#include "particles/distributed/ranks.hpp"
#include "particles/stepping/impacts.hpp"
#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// New velocities and shift (FreeMotion) of a grain that impacts have struck, and its velocity before.
struct StruckRecord {
  std::int64_t id = 0;
  double v_x = 0, v_z = 0, spin = 0;
  Point before;
  PathShift shift;
};

/// The part of one rank in the impacts of a step.
struct RankImpacts {
  const StepInput& step;  ///< its bodies are the grains that the rank sees, by ascending identity
  const RememberedLoads& loads;
  Bodies& bodies;                          ///< those of the step: one rank alone sets their velocities
  std::vector<PathShift>& shift;           ///< that of the step
  StepContacts& contacts;                  ///< pairs of the rank's tiles, in the order of (i, j)
  std::span<const std::int32_t> place_of;  ///< of each identity among the bodies; -1: not seen
  GrainSquare all;                         ///< where all grains of the run are
};

/// What impacts have sent to the rank that resolved them since the program began, from this rank.
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
  /// Pairs that met in the last call, counted once per impact.
  int count() const { return count_; }
  /// Pairs of the last call that met more often than is followed.
  int unresolved() const { return unresolved_; }
  /// On the first rank: impulses since the last clear(), with identities in place of indices, in the order in
  /// which they came about; empty on the others. All ranks call it together.
  std::vector<Strike> strikes() const;
  void clear() { strikes_.clear(), calls_ = 0; }
  const GatheredCounts& counts() const { return counts_; }

 private:
  /// A pair as it travels, with identities; j < 0 is a wall shape.
  struct PairRecord {
    std::int32_t i = 0, j = 0;
    double gap = 0, n_x = 0, n_z = 0, wall_v_x = 0, wall_v_z = 0, load = 0;
  };
  /// What impacts ask of a grain.
  struct BodyRecord {
    std::int32_t id = 0, whole = 0;  // whole: 1 if all ranks send all pairs of it
    double x = 0, z = 0, v_x = 0, v_z = 0, spin = 0, radius = 0, inverse_mass = 0;
    PathShift shift;
  };

  /// An impulse as ranks gather it.
  struct StrikeRecord {
    std::int32_t call = 0;  // of resolve(), since the last clear()
    Strike strike;
  };

  std::vector<StruckRecord> resolve_alone(const RankImpacts& mine);
  /// Whether any pair closes; the rank that has most of these is to resolve the impacts.
  bool choose_resolver(const RankImpacts& mine);
  bool resolves() const { return ranks_.rank() == resolver_; }
  /// Adds the bodies around the seeds of all ranks to those wanted, of which the resolving rank needs all
  /// pairs.
  void want_around(const Bodies& seen, double reach);
  /// Lists the pairs of wanted bodies that were not listed before, and the bodies that these name, by
  /// identity.
  void list_wanted(const RankImpacts& mine);
  /// Adds the pairs of wanted bodies to what the resolving rank holds.
  void send(const RankImpacts& mine);
  /// On that rank; nothing changes where missing_ bodies came in. `all`: it holds all pairs.
  void resolve_gathered(const StepInput& step, std::vector<StruckRecord>& struck);

  Ranks ranks_;
  Impacts looked_, impacts_;
  int resolver_ = 0;                    // rank
  std::vector<std::int32_t> seeds_;     // seen bodies that close, or that were missing
  NearPlaces near_;                     // those in it are wanted, on any rank
  std::vector<char> wanted_;            // of each seen body: all pairs of it are to be sent
  std::vector<char> pair_sent_, sent_;  // of each pair of this rank; of each seen body
  std::vector<PairRecord> listed_pairs_;
  std::vector<BodyRecord> listed_bodies_;
  // On the resolving rank.
  std::vector<PairRecord> pairs_;       // those that it holds, in the order of (i, j)
  std::vector<BodyRecord> bodies_;      // by identity
  std::vector<std::int32_t> place_of_;  // of each identity among them; others are not set
  std::vector<std::int32_t> missing_;   // identities
  std::vector<StrikeRecord> strikes_;   // of the calls in which this rank resolved
  std::int32_t calls_ = 0;
  GatheredCounts counts_;
  int count_ = 0, unresolved_ = 0;
};

}  // namespace drumlin::particles
