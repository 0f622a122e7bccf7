#pragma once
// The contacts of a rank in their tiles, and the rounds in which tiles are worked on.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/distributed/halo.hpp"
#include "particles/distributed/tile_order.hpp"
#include "particles/parallel/team_loops.hpp"

namespace drumlin::particles {

/// The contacts of a rank in their tiles, and what its bodies share with other ranks.
struct TiledContacts {
  std::span<const TileRange> tiles;  ///< in the order that `order` tells of
  const TileOrder& order;
  std::span<const char> counts_here;  ///< of each body: whether this rank is the one that counts it
  std::span<const double> x, z;       ///< where bodies are; empty: large problems are not corrected
};

/// Calls work(t) for the tiles of each colour, those at the border first, and in between begin(colour); then
/// end(colour).
template <class Work, class Begin, class End>
void each_colour(const TileRounds& rounds, const TeamLoops& loops, Work work, Begin begin, End end) {
  const auto all_of = [&](const std::vector<std::int32_t>& tiles) {
    loops.each_of(static_cast<int>(tiles.size()), [&](int k) { work(tiles[k]); });
  };
  for (int colour = 0; colour < 4; ++colour) {
    all_of(rounds[colour].border);
    begin(colour);
    all_of(rounds[colour].inner);
    end(colour);
  }
}

}  // namespace drumlin::particles
