#pragma once
// The tiles of a rank in the order of the memory, and in which order they are swept.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace drumlin::particles {

/// Contacts of one tile in a list.
struct TileRange {
  std::int32_t tile = 0, begin = 0, end = 0;
  std::int32_t colour = 0;
  bool border = false;  ///< a contact touches a grain that other ranks use
};

/// Two columns of tiles and the bodies from the middle of one odd column to that of the next
/// (TileGrid::strip_of_body). Ranges of places in the lists of a rank.
struct TileStrip {
  struct Range {
    std::int32_t begin = 0, end = 0;
  };
  Range phases[2];  ///< tiles of the even, then of the odd column
  Range bodies;
  bool border = false;  ///< other ranks touch what this one does
};

/// Tiles of one colour, as places in a list.
struct TileRound {
  std::vector<std::int32_t> border, inner;
  void add(std::int32_t place, bool at_border) { (at_border ? border : inner).push_back(place); }
};
using TileRounds = std::array<TileRound, 4>;

/// Of tiles that stand by strip, then colour, then number.
struct TileOrder {
  TileRounds rounds;
  std::vector<TileStrip> strips;  ///< neighbours of each other, some perhaps without tiles
};

TileRounds rounds_of(std::span<const TileRange> tiles);

}  // namespace drumlin::particles
