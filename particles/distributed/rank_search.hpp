#pragma once
// Which pairs of a step on ranks may touch once its impacts are over (docs/decisions/ranks.md, "Discs that
// impacts throw").
#include <cstdint>
#include <span>
#include <vector>

#include "particles/detection/contact_list.hpp"
#include "particles/distributed/gathered_impacts.hpp"
#include "particles/distributed/rank_grains.hpp"
#include "particles/distributed/ranks.hpp"
#include "particles/distributed/step_pairs.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/stepping/contact_memory.hpp"
#include "particles/stepping/impacts.hpp"
#include "particles/stepping/step_contacts.hpp"
#include "particles/stepping/step_laws.hpp"

namespace drumlin::particles {

/// Impacts of a step: pairs that met, and those of them that met more often than is followed.
struct ImpactCounts {
  int met = 0, unresolved = 0;
};

/// Finds them, and resolves the impacts, for one rank; all ranks call it together.
class RankSearch {
 public:
  /// `grains_of_all`: number of grains of the run; `unknowns`: per contact. What a search finds stands in the
  /// frame of the memory that is open then.
  RankSearch(const StepLaws& laws, const Ranks& ranks, std::int64_t grains_of_all, int unknowns,
             RankGrains& grains, ThreadTeam* team, WorkMemory* memory);

  /// A step of the grains that have been settled. The state of those that impacts strike changes, and grains
  /// may be settled again. Returns how many impacts there were.
  ImpactCounts find(RankState& state, const WallStep& walls, double time_step, Point gain);

  // Of the last search.
  std::span<const Candidate> candidates() const { return detection_.candidates(); }
  const HomedPairs& homed() const { return homed_; }
  const Recollection& recollection() const { return recollection_; }
  const GatheredImpacts& impacts() const { return impacts_; }
  /// Shifts of the grains that the rank sees (FreeMotion).
  const std::vector<PathShift>& shift() const { return free_.shift; }
  /// Gives back what the step no longer needs.
  void release() {
    free_memory_of(mine_.pairs), free_memory_of(homed_.homes), free_memory_of(homed_.mine);
    searched_ = {};
  }

 private:
  /// A grain that impacts have thrown, as ranks tell each other.
  struct ThrownRecord {
    std::int64_t id = 0;
    double push = 0;
  };
  /// A round of impacts: whom they struck, and which of these further than the search for pairs allowed for.
  struct Round {
    std::vector<StruckRecord> struck;
    std::vector<ThrownRecord> thrown;
  };
  /// What does not change within a step.
  struct Step {
    const WallStep& walls;
    double time_step = 0;
  };

  DetectionInput input(const Step&) const;
  void move_freely(const Step&);
  /// Looks at all grains.
  void search(const Step&);
  /// Adds the pairs that grains thrown in a round may meet now.
  void search_around(const Round&, const Step&);
  /// The same search, and those before it in this step, for the grains that the rank sees now that they have
  /// been sorted: when that happens must not decide which pairs are found.
  void search_as_before(const Step&);
  /// Whether to look around the thrown grains alone: the same answer on all ranks.
  bool is_local(std::span<const ThrownRecord>) const;
  /// Copies the pairs of this rank to mine_, in the order in which they are found.
  void take_mine();
  /// The impacts among all pairs; those of this rank's tiles are its part.
  std::vector<StruckRecord> strike(const Step&);
  /// Whether a pair of this rank meets after impacts and another search: only one of a grain that they struck
  /// can.
  bool strikes_again(std::span<const StruckRecord>, const Step&);
  /// Of the grains that the rank sees.
  void set_velocities(std::span<const StruckRecord>);
  /// Shifts of the grains that all rounds have struck, as the rank sees them now.
  void set_shifts();
  /// The state of own grains that impacts have struck.
  void take_over(std::span<const StruckRecord>, RankState&) const;
  /// The own grains that impacts have thrown further than the search for pairs allowed for.
  std::vector<ThrownRecord> thrown_of(std::span<const StruckRecord>, const Step&) const;

  const StepLaws& laws_;
  Ranks ranks_;
  std::int64_t grains_of_all_;
  int unknowns_;
  RankGrains& grains_;
  ContactDetection detection_;
  Recollection recollection_;
  GatheredImpacts impacts_;
  Impacts looking_;
  FreeMotion free_;
  FreeMotion searched_;                // velocities by which pairs were last looked for, grain by grain
  std::vector<StruckRecord> shifted_;  // by all rounds of the step, in their order
  std::vector<Round> rounds_;          // since all pairs were last looked for
  std::vector<ThrownGrain> thrown_;    // of a round
  StruckPairs struck_pairs_;
  std::vector<Candidate> pairs_of_struck_;
  HomedPairs homed_;            // of the candidates
  StepContacts mine_;           // those of this rank, with normals as impacts see them
  bool mine_is_fresh_ = false;  // they are as the last search has left the candidates
  TeamLoops loops_;
};

}  // namespace drumlin::particles
