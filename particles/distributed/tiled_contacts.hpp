#pragma once
// The contacts of a rank in their tiles, and the rounds in which tiles are worked on.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "particles/distributed/halo.hpp"
#include "particles/distributed/step_pairs.hpp"
#include "particles/parallel/team_loops.hpp"

namespace drumlin::particles {

/// The contacts of a rank in their tiles, and what its bodies share with other ranks.
struct TiledContacts {
  std::span<const TileRange> tiles;   ///< by colour, border tiles first
  std::span<const char> counts_here;  ///< of each body: whether this rank is the one that counts it
  std::span<const double> x, z;       ///< where bodies are; empty: large problems are not corrected
};

/// Calls work(t) for the tiles of each colour, those at the border first, and in between begin(colour); then
/// end(colour).
template <class Work, class Begin, class End>
void each_colour(std::span<const TileRange> tiles, const TeamLoops& loops, Work work, Begin begin, End end) {
  const auto some = [&](std::size_t from, std::size_t to) {
    loops.each_of(static_cast<int>(to - from), [&](int k) { work(from + k); });
  };
  std::size_t first = 0;
  for (int colour = 0; colour < 4; ++colour) {
    std::size_t inner = first;
    while (inner < tiles.size() && tiles[inner].colour == colour && tiles[inner].border) ++inner;
    std::size_t last = inner;
    while (last < tiles.size() && tiles[last].colour == colour) ++last;
    some(first, inner);
    begin(colour);
    some(inner, last);
    end(colour);
    first = last;
  }
}

}  // namespace drumlin::particles
