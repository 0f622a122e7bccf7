#pragma once
// The grains that a rank sees in a step, and the impulses that it remembers for them: the forest suited to
// the step, and what it took to bring everything to the rank that needs it.
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "particles/distributed/forest.hpp"
#include "particles/distributed/rank_step.hpp"
#include "particles/distributed/step_pairs.hpp"
#include "particles/effects/wall_step.hpp"
#include "particles/stepping/contact_memory.hpp"
#include "particles/stepping/step_laws.hpp"

namespace drumlin::particles {

/// The forest sorts grains into its cells only when one of any rank has moved too far for that: until then a
/// rank sees the same grains. When that is decides nothing but the time a step takes.
class RankGrains {
 public:
  RankGrains(const Ranks& ranks, const Domain& domain, bool with_spin, int unknowns, double margin)
      : ranks_(ranks), domain_(domain), with_spin_(with_spin), unknowns_(unknowns), margin_(margin) {}

  /// Brings grains and memory to the ranks that own their tiles, and ghosts to those that see them. `gain`:
  /// what forces add to velocities within the step.
  void settle(RankState& state, const WallStep& walls, double time_step, Point gain);
  /// The same once velocities have changed, where they need larger cells; false if they do not.
  bool settle_again(RankState& state, const WallStep& walls, double time_step, Point gain);

  SeenGrains& seen() { return seen_; }
  const SeenGrains& seen() const { return seen_; }
  const TileMap& tiles() const { return now_.forest->tiles(); }
  /// What the last call of settle() or settle_again() asked for: the same on all ranks, however often grains
  /// were sorted.
  const Reach& reach() const { return reach_; }
  std::size_t ghosts() const { return now_.forest->ghosts().size(); }
  /// Made so far.
  std::int64_t forests() const { return forests_; }
  /// Steps in which grains were sorted into the cells.
  std::int64_t sorts() const { return sorts_; }
  /// Place of a grain among those seen; -1: not seen.
  std::int32_t place_of(std::int64_t id) const { return place_of_[id]; }
  /// The same of all identities.
  std::span<const std::int32_t> places() const { return place_of_; }
  /// What is remembered of pairs of seen grains, with their places.
  const ContactMemory& memory() const { return memory_; }
  /// Forgets that, and gives its memory back.
  void release_memory() { memory_ = {}; }

 private:
  /// A forest and how it was made.
  struct Made {
    std::unique_ptr<Forest> forest;
    bool knows_contacts = false;  ///< by its weights
    std::int64_t steps = 0;       ///< in which it was used
  };
  /// What a step asks of the forest.
  struct Need {
    Reach reach;
    double drift = 0;      ///< the furthest way of a grain since they were sorted
    bool outside = false;  ///< a grain has left the grid
  };
  /// The largest of several numbers of grains, which ranks compare in one round.
  struct Extremes {
    static constexpr double none = -1e300;
    /// Of velocities, with what forces add to them, along x, -x, z, -z; of the squares of speed and drift; 1
    /// if a grain is outside.
    std::array<double, 7> numbers{none, none, none, none, 0, 0, 0};
    void raise(std::size_t k, double number) { numbers[k] = std::max(numbers[k], number); }
    void add(double v_x, double v_z) {
      raise(0, v_x), raise(1, -v_x), raise(2, v_z), raise(3, -v_z);
      raise(4, v_x * v_x + v_z * v_z);
    }
  };
  /// A grain that other ranks see, as it is now.
  struct Shown {
    double x, z, v_x, v_z, spin;
  };

  Need need_of(const RankState&, const WallStep&, double time_step, Point gain) const;
  /// The reach of the velocities that seen grains have by now; nobody has moved since settle().
  Reach reach_again(const WallStep&, double time_step, Point gain) const;
  Reach reach_of(const Extremes& of_all, const WallStep&, double time_step) const;
  /// Whether the cells still hold what a rank must see.
  bool still_sorted() const;
  void build(RankState&, const TileGrid&);
  void change_forest(RankState&, const TileGrid&);
  void sort(RankState&);
  bool unbalanced(const RankState&) const;
  void take_sorted(RankState&);
  void see(const RankState&);
  void agree_on_ghosts();
  void follow(const RankState&);
  std::size_t pass_memory_on(std::vector<RememberedContact>&) const;
  /// Remembered impulses of pairs that this rank sees, with its numbers of grains, in order.
  void bring_memory(RankState&);
  void refuse(const GrainOutside&) const;

  Ranks ranks_;
  Domain domain_;
  bool with_spin_;
  int unknowns_;  // per contact
  double margin_;
  Made now_;
  std::vector<Made> earlier_;  // for other grids, the last ones first; they hold no grains
  Reach reach_;
  double drift_ = 0;  // the furthest way of a grain of any rank since they were sorted
  SeenGrains seen_;
  std::vector<Point> sorted_at_;                      // own grains
  std::vector<std::vector<std::int32_t>> shown_to_;   // by rank: own grains that it sees, in its order
  std::vector<std::vector<std::int32_t>> ghosts_of_;  // by rank: its grains among those seen
  std::vector<std::vector<Shown>> to_show_;
  std::vector<std::int32_t> place_of_;
  ContactMemory memory_;
  std::int64_t forests_ = 0, sorts_ = 0;
};

}  // namespace drumlin::particles
