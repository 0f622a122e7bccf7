#include "particles/distributed/tile_order.hpp"

namespace drumlin::particles {

TileRounds rounds_of(std::span<const TileRange> tiles) {
  TileRounds rounds;
  for (std::size_t t = 0; t < tiles.size(); ++t)
    rounds[tiles[t].colour].add(static_cast<std::int32_t>(t), tiles[t].border);
  return rounds;
}

}  // namespace drumlin::particles
