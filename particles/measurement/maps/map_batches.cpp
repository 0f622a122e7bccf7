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

}  // namespace

MapBatches::MapBatches(const CoarseGraining& graining, std::shared_ptr<ScratchFile> file)
    : graining_(graining), file_(std::move(file)) {}

void MapBatches::put_away(const MapSums& sums) {
  snapshots_.push_back(sums.snapshots);
  rows_reached_ = std::max(rows_reached_, rows_with_grains(graining_, sums.nodes));
  std::vector<std::uint64_t>& places = places_.emplace_back();
  places.reserve(sums.nodes.tiles());
  for (std::size_t t = 0; t < sums.nodes.tiles(); ++t) {
    const std::vector<MapNode>& tile = sums.nodes.tile(t);
    places.push_back(tile.empty() ? zeros : file_->append(std::as_bytes(std::span(tile))));
  }
}

void MapBatches::read(std::size_t tile, std::vector<std::vector<MapNode>>& batches) const {
  batches.resize(places_.size());
  for (std::size_t b = 0; b < places_.size(); ++b) {
    const std::uint64_t place = places_[b][tile];
    batches[b].resize(place == zeros ? 0 : NodeTiles<MapNode>::nodes_per_tile);
    if (place != zeros) file_->read(place, std::as_writable_bytes(std::span(batches[b])));
  }
}

std::size_t MapBatches::bytes_in_memory() const {
  std::size_t bytes = 0;
  for (const auto& places : places_) bytes += places.capacity() * sizeof(std::uint64_t);
  return bytes;
}

}  // namespace drumlin::particles
