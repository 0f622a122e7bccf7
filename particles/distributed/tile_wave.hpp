#pragma once
// Which strips of tiles several sweeps go through at once, and what is left of these sweeps.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/distributed/tile_order.hpp"
#include "particles/solver/sweep_wave.hpp"

namespace drumlin::particles {

/// The strips between those that other ranks touch, in one share for each thread where they are wide enough:
/// sweep_alone() goes through each of them without messages.
std::vector<StripShare> shares_between_borders(std::span<const TileRange> tiles, const TileOrder& order,
                                               int sweeps, int threads);

/// What the shares leave of sweep s: strips whose bodies are to go on, and tiles.
struct LeftOfSweep {
  std::vector<std::int32_t> strips;
  TileRounds rounds;
  bool nothing() const;
};
void find_left(std::span<const TileRange> tiles, const TileOrder& order, std::span<const StripShare> shares,
               int s, LeftOfSweep& left);

}  // namespace drumlin::particles
