#pragma once
// The contacts of a step on one rank: which are its own, in which order, and which grains they share with
// other ranks.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/distributed/halo.hpp"
#include "particles/distributed/tile_order.hpp"
#include "particles/distributed/tiles.hpp"

namespace drumlin::particles {

/// Grains that a rank sees: its own and those of one layer of cells around, by ascending identity.
struct SeenGrains {
  Bodies bodies;                    ///< with identities
  std::vector<std::int32_t> owner;  ///< rank of each
  std::vector<std::int32_t> place;  ///< of own grains: their places in RankState::grains; else -1
};

/// Candidates among the grains that a rank sees, in the order of (i, j), and where they are at home.
struct HomedPairs {
  /// A tile and who owns it.
  struct Home {
    std::int32_t tile = 0, owner = 0;
  };
  std::vector<Home> homes;         ///< of each candidate
  std::vector<std::int32_t> mine;  ///< candidates of the rank's tiles
};

/// What a rank solves. Indices are places in `used`.
struct RankPairs {
  std::vector<std::int32_t> used;     ///< grains of SeenGrains by strip: as contacts first touch them, others
  std::vector<std::int32_t> in_used;  ///< of each seen grain; -1: not used
  std::vector<Candidate> pairs;       ///< its contacts: by strip, colour, tile, (i, j)
  std::vector<std::int32_t> order;    ///< place of each of them in HomedPairs::mine
  std::vector<TileRange> tiles;       ///< the same, tile by tile
  TileOrder tile_order;
  HaloPlan halo;
};

/// Where a pair is: between the centres of two grains, or at the centre of a grain at a wall.
inline Point middle_of(const Candidate& pair, const Bodies& bodies) {
  if (pair.j < 0) return {bodies.x[pair.i], bodies.z[pair.i]};
  return {(bodies.x[pair.i] + bodies.x[pair.j]) / 2, (bodies.z[pair.i] + bodies.z[pair.j]) / 2};
}

void find_homes(const SeenGrains& seen, std::span<const Candidate> candidates, const TileMap& tiles,
                std::int32_t rank, HomedPairs& found);
/// The same where candidates have come in since, at the places `added`, ascending. Returns the places in
/// HomedPairs::mine of those that are the rank's.
std::vector<std::int32_t> find_homes_of_added(const SeenGrains& seen, std::span<const Candidate> candidates,
                                              std::span<const std::int32_t> added, const TileMap& tiles,
                                              std::int32_t rank, HomedPairs& found);

/// Takes the contacts of the rank's tiles from all candidates; what `own` was is lost, but for its memory.
void find_rank_pairs(const SeenGrains& seen, std::span<const Candidate> candidates, const HomedPairs& homed,
                     const TileMap& tiles, std::int32_t rank, RankPairs& own);

}  // namespace drumlin::particles
