#pragma once
// A step on ranks: that of particles/stepping/moreau_jean.hpp, with the grains spread over ranks. The state
// after it is the same bytes for any number of ranks and threads.
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "particles/distributed/forest.hpp"
#include "particles/distributed/gathered_impacts.hpp"
#include "particles/distributed/ranks.hpp"
#include "particles/stepping/left_grains.hpp"
#include "particles/stepping/moreau_jean.hpp"

namespace drumlin::particles {

/// Impulses that a contact remembers: what the next step of its pair starts from.
struct RememberedContact {
  std::int64_t i = 0, j = 0;  ///< identities; j < 0: wall shape -1 - j
  double x = 0, z = 0;        ///< where the pair is; one rank alone does not use it
  std::array<double, 2> impulse{};
};

/// The order of (i, j).
inline bool comes_before(const RememberedContact& a, const RememberedContact& b) {
  return a.i != b.i ? a.i < b.i : a.j < b.j;
}

/// What a rank keeps from step to step.
struct RankState {
  std::vector<RankGrain> grains;          ///< its own
  std::vector<RememberedContact> memory;  ///< of the contacts that it solved
  double memory_time_step = 0;
};

/// What a run costs on this rank, since it began.
struct RankCounts {
  std::int64_t steps = 0, sweeps = 0;
  std::int64_t halo_rounds = 0, halo_bytes = 0;  ///< between the colours of sweeps
  std::int64_t rounds = 0;                       ///< of messages among all ranks
  std::int64_t contacts = 0, grains = 0, ghosts = 0, shared_bytes_per_sweep = 0;  ///< summed over steps
  std::int64_t forests = 0;                                                       ///< made
  std::int64_t sorts = 0;                        ///< of grains into the cells of a forest
  double step_seconds = 0, waiting_seconds = 0;  ///< processor time of the steps, and what of it was waiting
  std::int64_t corrections = 0;                  ///< of impulses on a coarse grid
  GatheredCounts impacts;
};

/// The square that holds a run.
struct Domain {
  Point low;
  double edge = 0;
  double largest = 0;       ///< diameter of a grain
  std::int64_t grains = 0;  ///< identities are 0 to this
};

class RankStepper {
 public:
  virtual ~RankStepper() = default;
  /// The report is the same on all ranks, its times aside; a lost grain is named by its identity. Throws
  /// NotConvergedError on all ranks when a grain leaves the domain or, with more ranks than one, jumps over
  /// cells, and names it.
  virtual StepReport advance(RankState& state, WallStep& walls, double time_step) = 0;
  /// Contacts of this rank that the last step has loaded, with identities. Gives memory back, as below.
  virtual std::vector<SnapshotContact> loaded_contacts() = 0;
  /// Impulses that impacts of the last step have added, in their order: on the first rank, none on the
  /// others. All ranks call it together; also after release_memory().
  virtual std::vector<SnapshotContact> strikes() const = 0;
  /// Between steps: gives back what the next step makes anew, if that is much. The contacts of the last step
  /// are gone then.
  virtual void release_memory() = 0;
  virtual const RankCounts& counts() const = 0;
};

/// As make_stepper(); the laws are those of a scene that runs_on_ranks().
std::unique_ptr<RankStepper> make_rank_stepper(const StepLaws& laws, const StepSolver& solver,
                                               const Domain& domain, const Ranks& ranks);

}  // namespace drumlin::particles
