#pragma once
// NLGS, plain and accelerated, on the bodies, in strips (particles/contact/sweep_plan.hpp): vectorised and
// threaded and shared among ranks, with the same result for any number of them.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/contact/sweep_plan.hpp"
#include "particles/parallel/parallel_loops.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/parallel/world.hpp"
#include "particles/solver/driven_contacts.hpp"
#include "particles/solver/pipelined_sweeps.hpp"
#include "particles/solver/sweep_kernels.hpp"

namespace drumlin::particles {

/// A contact problem in blocks of eight, ready to be swept, and its state. T is the precision of the sweeps.
template <class T, class Law, bool spin>
class StripProblem {
 public:
  static constexpr int dim = Law::unknowns;
  using Kernels = SweepKernels<T, Law, spin>;
  using Block = ContactBlock<T, Law>;
  static constexpr int sum_slots = 2 * longest_pipeline;
  /// Parts of about as many blocks each, whatever the number of threads and ranks; ranks have whole parts.
  static constexpr int parts = 16;

  /// Takes its blocks and bodies from a memory: they end with the scope of pack().
  void use(WorkMemory* memory) {
    blocks_.use(memory), contact_.use(memory), bodies_.use(memory), before_.use(memory);
    place_.use(memory), kept_.use(memory);
  }
  /// Copies a problem in body form and the impulses to start from. `order`: contacts of the problem in the
  /// order of the plan; empty if they stand in it. With a world, ranks share the strips; but contacts in
  /// another order, those of driven walls and small problems are left to each of them.
  template <class Problem>
  void pack(const Problem& problem, const SweepPlan& plan, std::span<const std::int32_t> order,
            std::span<const double> r, const ParallelLoops& loops, World* world = nullptr);
  /// Impulses in the order of the problem, held to their cones, which single precision oversteps by a
  /// rounding. `kept`: those of the last keep().
  template <class Problem>
  void unpack(const Problem& problem, bool kept, std::vector<double>& r, const ParallelLoops& loops) const;

  /// Lets the bodies rest: they are loaded anew after it.
  void rest(const ParallelLoops& loops);

  int strips() const { return static_cast<int>(strips_.size()); }
  int rank() const { return rank_; }
  int ranks() const { return ranks_; }  ///< that share the strips; 1: this one has all
  /// First strip of a part, or of the end.
  int first_of(int part) const;
  /// Parts of this rank: the first, and the end.
  std::pair<int, int> own_parts() const { return {first_part(rank_), first_part(rank_ + 1)}; }
  /// Strips of this rank: the first, and the end.
  std::pair<int, int> own() const { return {strips_of_ranks_[rank_], strips_of_ranks_[rank_ + 1]}; }
  /// First strip of a thread's share of those of a rank: strips are shared by numbers of blocks.
  int first_strip(int rank, int thread, int threads) const;

  // What ranks tell each other; without others nothing.
  /// After a phase: records of bodies that contacts of two ranks touch go to the rank that touches them next.
  void exchange(int phase) { exchange(phase, bodies_); }
  void exchange(int phase, WorkArray<BodyRecord<T>>& records);
  void gather_steps(int slot);
  void gather_estimates();
  /// Of an array with so many entries for each part, those of all ranks.
  void gather_parts(std::span<double> all, std::size_t of_part) const;

  // Work on one strip; threads meet between phases.
  /// Bodies receive the impulses to start from.
  void load(int strip, int phase);
  /// Remembers the bodies as the beginning of the first sweep.
  void start(int strip);
  /// Extrapolated by beta; bodies go on in phase 0, before any contact of theirs. `slot`,
  /// of sum_slots: where the sums of the sweep stand, apart from those that others may be adding up.
  void sweep(int strip, int phase, int slot, T beta, SweepExtrapolation);
  /// Sum of squares of the steps of a sweep over all strips, in the order of the slices; all threads must
  /// have met after it.
  double step_squares(int slot) const;

  /// Whether there are contacts of driven walls: one thread sweeps them after the second phase.
  bool has_driven() const { return !driven_.empty(); }
  void load_driven();
  void start_driven();
  void sweep_driven(int slot, T beta, bool accelerated);

  /// Looks at the residuals of the contacts of a phase of a strip; what it saw of all of them, and of driven
  /// walls.
  void estimate_residual(int strip, int phase);
  ResidualEstimate residual_estimate() const;
  /// Sum of the impulses of the bodies as they stand.
  double summed_impulses(const ParallelLoops& loops);
  /// Keeps the impulses of a strip, and those of driven walls.
  void keep(int strip);
  void keep_driven();

  // As contacts and bodies stand.
  std::span<Block> blocks(int strip, int phase) {
    const Strip& l = strips_[strip];
    return {blocks_.data() + l.block[phase], l.block[phase + 1] - l.block[phase]};
  }
  std::span<const BodyRecord<T>> bodies() const { return {bodies_.data(), bodies_.size()}; }
  /// First record of a strip, and the end: with a few that do not move.
  std::pair<std::size_t, std::size_t> records(int strip) const {
    return {strips_[strip].bodies, strips_[strip].bodies_end};
  }
  /// The record of each body.
  std::span<const std::int32_t> record() const { return {place_.data(), place_.size()}; }

 private:
  struct Strip {
    std::size_t bodies = 0, bodies_end = 0;  // those of wall contacts, which do not move, stand last
    std::size_t block[3] = {0, 0, 0};        // first block of each phase, and the end
    std::size_t group[3] = {0, 0, 0};        // likewise in groups_
  };
  using Impulses = std::array<std::array<T, Block::width>, dim>;  // of a block

  template <class Problem>
  void pack_bodies(const Problem& problem, const SweepPlan& plan);
  /// Where the blocks of each slice stand; contacts of driven walls are packed apart.
  template <class Problem>
  void lay_out(const Problem& problem, const SweepPlan& plan, std::span<const std::int32_t> order,
               std::span<const double> r);
  template <class Problem>
  void pack_strip(const Problem& problem, const SweepPlan& plan, std::span<const std::int32_t> order,
                  std::span<const double> r, int strip);
  /// Contact c, or none (-1).
  template <class Problem>
  void pack_place(const Problem& problem, std::int32_t c, std::int32_t fixed, std::span<const double> r,
                  std::size_t place);
  template <class Problem>
  void pack_driven(const Problem& problem, std::int32_t c, std::span<const double> r);
  /// Shares the strips among as many ranks of a world as have some each.
  void share(World* world);
  int strip_at(std::size_t block, int begin, int end) const;
  int first_part(int rank) const { return parts * std::min(rank, ranks_) / ranks_; }
  /// Records of the first bodies of a strip that contacts of the strip before touch.
  template <class Problem>
  std::vector<std::int32_t> border_of(const Problem& problem, const SweepPlan& plan, int strip) const;
  /// Of an array with so many entries for each strip, those of all ranks.
  template <class Entry>
  void gather(std::span<Entry> all, std::size_t of_strip) const;

  const DiscDelassus<Law::unknowns, spin>* W_ = nullptr;  // of the problem that was packed
  std::vector<Strip> strips_;
  World* world_ = nullptr;  // none where this rank has all strips
  int rank_ = 0, ranks_ = 1;
  std::vector<int> strips_of_ranks_;            // first strip of each rank of the world, and the end
  std::vector<std::int32_t> border_[2];         // records that the rank before, and the one after, touch too
  std::vector<std::size_t> contacts_of_ranks_;  // first contact of each rank of the world, and the end
  std::vector<BodyRecord<T>> sent_, received_;  // of the borders
  std::vector<double> impulses_of_strips_;      // summed
  WorkArray<Block> blocks_;
  std::vector<std::int32_t> groups_;  // blocks that share no body: how many follow one another
  WorkArray<std::int32_t> contact_;   // of each position in the blocks; -1: filled up
  WorkArray<BodyRecord<T>> bodies_, before_;
  WorkArray<std::int32_t> place_;                // of each body in bodies_
  std::vector<double> step_squares_[sum_slots];  // of each slice, of the sweeps of two pipelines
  std::vector<ResidualEstimate> estimates_;      // of each slice
  WorkArray<Impulses> kept_;                     // of each block
  std::vector<DrivenContact<Law>> driven_;
  std::size_t driven_bodies_ = 0;  // first of them in bodies_
};

}  // namespace drumlin::particles
