#include "particles/measurement/maps/map_batches.hpp"

#include <algorithm>
#include <utility>

namespace drumlin::particles {
namespace {

std::size_t rows_with_grains(const CoarseGraining& graining, const NodeTiles<MapNode>& nodes) {
  const auto is_empty = [&](std::size_t row) {
    for (std::size_t column = 0; column < graining.grid.columns; ++column)
      if (nodes(column, row).grain[0] != 0) return false;
    return true;
  };
  std::size_t rows = graining.grid.rows;
  while (rows > 1 && is_empty(rows - 1)) --rows;
  return rows;
}

}  // namespace

NodeSums TileOfBatches::sums(std::size_t batch, std::size_t place) const {
  const Batch& from = batches[batch];
  NodeSums result;
  if (!from.nodes.empty()) result.node = from.nodes[place];
  if (!from.own_area)
    result.area = result.node.grain[3];
  else if (!from.area.empty())
    result.area = from.area[place];
  return result;
}

DisplacementNode TileOfBatches::displacement(std::size_t batch, std::size_t place) const {
  const auto& nodes = batches[batch].displacements;
  return nodes.empty() ? DisplacementNode{} : nodes[place];
}

MapBatches::MapBatches(const CoarseGraining& graining, std::shared_ptr<ScratchFile> file)
    : graining_(graining), file_(std::move(file)) {}

void MapBatches::put_away(const MapSums& sums, const DisplacementSums& displacements) {
  MapShare share;
  share.add(sums);
  total_.add(sums);
  pairs_ += displacements.pairs;
  time_ += displacements.time;
  rows_reached_ = std::max(rows_reached_, rows_with_grains(graining_, sums.nodes));
  Batch batch{share, {sums.nodes, *file_}, std::nullopt, {displacements.nodes, *file_}};
  if (sums.area) batch.area.emplace(*sums.area, *file_);
  batches_.push_back(std::move(batch));
}

void MapBatches::read(std::size_t tile, TileOfBatches& sums) const {
  sums.batches.resize(batches_.size());
  for (std::size_t b = 0; b < batches_.size(); ++b) {
    TileOfBatches::Batch& into = sums.batches[b];
    batches_[b].nodes.read(tile, *file_, into.nodes);
    into.own_area = batches_[b].area.has_value();
    if (into.own_area) batches_[b].area->read(tile, *file_, into.area);
    batches_[b].displacements.read(tile, *file_, into.displacements);
  }
}

std::size_t MapBatches::bytes_in_memory() const {
  std::size_t bytes = file_->bytes_in_memory();
  for (const Batch& batch : batches_)
    bytes += batch.nodes.bytes() + (batch.area ? batch.area->bytes() : 0) + batch.displacements.bytes();
  return bytes;
}

}  // namespace drumlin::particles
