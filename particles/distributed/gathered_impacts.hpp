#pragma once
// Impacts of a step on ranks: resolved by the first rank for all, since a pass may move a whole packing at
// once. A step in which no pair closes fast enough gathers nothing.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/distributed/forest.hpp"
#include "particles/distributed/ranks.hpp"
#include "particles/stepping/impacts.hpp"
#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// New velocities of a grain that impacts have struck.
struct StruckRecord {
  std::int64_t id = 0;
  double v_x = 0, v_z = 0, spin = 0;
};

class GatheredImpacts {
 public:
  explicit GatheredImpacts(const Ranks& ranks) : ranks_(ranks) {}

  /// Resolves the impacts among the pairs of all ranks. `contacts`: pairs of this rank alone, among the
  /// grains of `step`, whose identities are ascending; `own`: grains that this rank owns. All ranks call it
  /// together and get the grains that were struck. `step.laws` asks for restitution.
  std::vector<StruckRecord> resolve(const StepInput& step, const RememberedLoads& loads,
                                    const StepContacts& contacts, std::span<const RankGrain> own);
  /// Pairs that met in the last call, counted once per pass.
  int count() const { return count_; }
  /// On the first rank: impulses since the last clear(), with identities in place of indices.
  const std::vector<Strike>& strikes() const { return strikes_; }
  void clear() { strikes_.clear(); }

 private:
  std::vector<StruckRecord> resolve_for_all(const StepInput& step, std::span<const RankGrain> grains);

  /// A pair as it travels; j < 0 is a wall shape.
  struct PairRecord {
    std::int64_t i = 0, j = 0;
    double gap = 0, n_x = 0, n_z = 0, wall_v_x = 0, wall_v_z = 0, load = 0;
  };

  Ranks ranks_;
  Impacts looked_, impacts_;
  std::vector<PairRecord> pairs_;  // of all ranks, on the first
  std::vector<Strike> strikes_;
  int count_ = 0;
};

}  // namespace drumlin::particles
