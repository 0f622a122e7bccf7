#pragma once
// The contacts of a rank in blocks of eight, tile by tile, ready for the kernels of the solver in strips
// (particles/solver/sweep_kernels.hpp).
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/distributed/halo.hpp"
#include "particles/distributed/tile_order.hpp"
#include "particles/parallel/team_loops.hpp"
#include "particles/solver/sweep_kernels.hpp"

namespace drumlin::particles {

/// T is the precision of the sweeps. Within a tile contacts stand by greedy colour, so that a block shares no
/// body; nothing but the contacts of the tile, in the order of their identities, decides their order.
template <class T, int dim, bool spin>
class TileBlocks {
 public:
  using Block = ContactBlock<T, dim>;

  /// Copies a problem in body form and the impulses to start from; bodies are at rest. Best where bodies are
  /// numbered tile by tile, as find_rank_pairs() does.
  template <class Problem>
  void pack(const Problem& problem, std::span<const TileRange> tiles, std::span<const double> r,
            const TeamLoops& loops);
  /// Impulses in the order of the problem, held to their cones. `kept`: those of the last keep().
  template <class Problem>
  void unpack(const Problem& problem, bool kept, std::vector<double>& r, const TeamLoops& loops) const;

  // Work on the bodies that a tile touches; tiles of one colour may be worked on side by side.
  /// Bodies receive the impulses to start from.
  void load(std::size_t tile);
  /// One Gauss-Seidel sweep; returns the sum of squares of its steps.
  double sweep(std::size_t tile, T beta, SweepExtrapolation);
  /// The residual as impulses and bodies stand.
  ResidualEstimate residual(std::size_t tile) const;
  void keep(std::size_t tile);

  /// Lets the bodies rest: load() and start() have to follow.
  void rest(const TeamLoops& loops);
  /// Remembers the bodies as the beginning of the first sweep.
  void start();
  /// Bodies of a strip go on by beta, before a sweep.
  void go_on(const TileStrip& strip, T beta);

  std::array<double, Halo::numbers> numbers(std::int32_t body) const {
    const BodyRecord<T>& record = bodies_[body];
    return {record.x, record.z, record.s};
  }
  void set_numbers(std::int32_t body, const std::array<double, Halo::numbers>& numbers) {
    BodyRecord<T>& record = bodies_[body];
    record.x = static_cast<T>(numbers[0]), record.z = static_cast<T>(numbers[1]);
    record.s = static_cast<T>(numbers[2]);
  }

  // As contacts and bodies stand.
  std::span<Block> all() { return blocks_; }
  std::span<Block> of_tile(std::size_t tile) {
    return all().subspan(tiles_[tile].block, tiles_[tile + 1].block - tiles_[tile].block);
  }
  /// Those of the problem, then some that do not move.
  std::span<const BodyRecord<T>> bodies() const { return bodies_; }

 private:
  using Kernels = SweepKernels<T, dim, spin>;
  using Impulses = std::array<std::array<T, Block::width>, dim>;
  /// First of a tile; those of the next one end it.
  struct Tile {
    std::size_t block = 0, group = 0;
  };

  template <class Problem>
  void pack_bodies(const Problem& problem, std::size_t tiles);
  /// Groups of contacts of one colour each, in order_ and group_end_.
  template <class Problem>
  void colour(const Problem& problem, const TileRange& tile);
  template <class Problem>
  void pack_tile(const Problem& problem, std::span<const double> r, std::size_t tile);
  template <class Problem>
  void pack_place(const Problem& problem, std::int32_t c, std::int32_t fixed, std::span<const double> r,
                  std::size_t place);

  std::vector<Tile> tiles_;
  std::vector<Block> blocks_;
  std::vector<std::int32_t> groups_;             // blocks that share no body: how many follow one another
  std::vector<std::int32_t> order_, group_end_;  // contacts of all groups; where each group ends there
  std::vector<std::int8_t> colour_;              // of each contact, while a tile is coloured
  std::vector<std::int32_t> contact_;            // of each place in the blocks; -1: filled up
  std::vector<BodyRecord<T>> bodies_, before_;   // of the problem; then the fixed ones of each tile
  std::size_t moving_ = 0;                       // bodies before the fixed ones
  std::vector<std::uint64_t> used_;              // colours of the contacts of each body in a tile
  std::vector<Impulses> kept_;
};

}  // namespace drumlin::particles
