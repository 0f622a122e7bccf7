#include "particles/measurement/maps/map_batches.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace drumlin::particles {
namespace {

constexpr std::uint64_t zeros = UINT64_MAX;  // stands for the place of a tile that nobody wrote

std::size_t rows_with_grains(const CoarseGraining& graining, const NodeTiles<MapNode>& nodes) {
  const auto is_empty = [&](std::size_t row) {
    for (std::size_t column = 0; column < graining.grid.columns; ++column)
      if (nodes(column, row).grains != 0) return false;
    return true;
  };
  std::size_t rows = graining.grid.rows;
  while (rows > 1 && is_empty(rows - 1)) --rows;
  return rows;
}

template <class Node>
std::vector<std::uint64_t> put_tiles(const NodeTiles<Node>& nodes, ScratchFile& file) {
  std::vector<std::uint64_t> places;
  places.reserve(nodes.tiles());
  for (std::size_t t = 0; t < nodes.tiles(); ++t) {
    const std::vector<Node>& tile = nodes.tile(t);
    places.push_back(tile.empty() ? zeros : file.append(std::as_bytes(std::span(tile))));
  }
  return places;
}

template <class Node>
void read_tile(std::size_t tile, const std::vector<std::vector<std::uint64_t>>& places,
               const ScratchFile& file, std::vector<std::vector<Node>>& batches) {
  batches.resize(places.size());
  for (std::size_t b = 0; b < places.size(); ++b) {
    const std::uint64_t place = places[b].empty() ? zeros : places[b][tile];
    batches[b].resize(place == zeros ? 0 : NodeTiles<Node>::nodes_per_tile);
    if (place != zeros) file.read(place, std::as_writable_bytes(std::span(batches[b])));
  }
}

}  // namespace

MapBatches::MapBatches(const CoarseGraining& graining, std::shared_ptr<ScratchFile> file)
    : graining_(graining), file_(std::move(file)) {}

void MapBatches::put_away(const MapSums& sums) {
  snapshots_.push_back(sums.snapshots);
  rows_reached_ = std::max(rows_reached_, rows_with_grains(graining_, sums.nodes));
  places_.push_back(put_tiles(sums.nodes, *file_));
  space_.push_back(put_tiles(sums.space, *file_));
}

void MapBatches::read(std::size_t tile, std::vector<std::vector<MapNode>>& batches) const {
  read_tile(tile, places_, *file_, batches);
}

void MapBatches::read(std::size_t tile, std::vector<std::vector<SpaceNode>>& batches) const {
  read_tile(tile, space_, *file_, batches);
}

std::size_t MapBatches::bytes_in_memory() const {
  std::size_t bytes = 0;
  for (const auto* of : {&places_, &space_})
    for (const auto& places : *of) bytes += places.capacity() * sizeof(std::uint64_t);
  return bytes;
}

}  // namespace drumlin::particles
