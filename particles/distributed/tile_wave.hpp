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

/// What the shares leave of a sweep: strips whose bodies are to go on, and tiles.
struct LeftOfSweep {
  std::vector<std::int32_t> strips;
  TileRounds rounds;
  bool nothing() const;
};
LeftOfSweep left_of_sweep(std::span<const TileRange> tiles, const TileOrder& order,
                          std::span<const StripShare> shares, int s);

/// Who does what in a wave; the same for all waves of so many sweeps of a solve.
struct WavePlan {
  std::vector<StripShare> shares;
  std::vector<LeftOfSweep> left;  ///< of each sweep
};
WavePlan wave_plan(std::span<const TileRange> tiles, const TileOrder& order, std::vector<StripShare> shares,
                   int sweeps);

}  // namespace drumlin::particles
