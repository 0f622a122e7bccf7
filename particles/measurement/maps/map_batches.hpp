#pragma once
// The sums of all batches of a run, read back tile after tile.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "coupling/common/scratch_file.hpp"
#include "particles/measurement/maps/displacement_sums.hpp"
#include "particles/measurement/maps/field_values.hpp"
#include "particles/measurement/maps/map_sums.hpp"

namespace drumlin::particles {

/// Node sums that wait in a scratch file: the tiles of one NodeTiles.
template <class Node>
class StoredTiles {
 public:
  StoredTiles(const NodeTiles<Node>& nodes, ScratchFile& file) {
    places_.reserve(nodes.tiles());
    for (std::size_t t = 0; t < nodes.tiles(); ++t)
      places_.push_back(nodes.tile(t).empty() ? zeros : file.append(std::as_bytes(std::span(nodes.tile(t)))));
  }
  /// Fills `tile`; leaves it empty where it has nothing but zeros.
  void read(std::size_t t, const ScratchFile& file, std::vector<Node>& tile) const {
    tile.resize(places_[t] == zeros ? 0 : NodeTiles<Node>::nodes_per_tile);
    if (!tile.empty()) file.read(places_[t], std::as_writable_bytes(std::span(tile)));
  }
  std::size_t bytes() const { return places_.capacity() * sizeof(std::uint64_t); }

 private:
  static constexpr std::uint64_t zeros = UINT64_MAX;
  std::vector<std::uint64_t> places_;
};

/// Sums of every batch at the nodes of one tile, node by node.
struct TileOfBatches {
  struct Batch {
    std::vector<MapNode> nodes;
    std::vector<double> area;  ///< beside their mass
    bool own_area = false;
    std::vector<DisplacementNode> displacements;
  };
  std::vector<Batch> batches;

  NodeSums sums(std::size_t batch, std::size_t place) const;
  DisplacementNode displacement(std::size_t batch, std::size_t place) const;
};

/// Of the batches put away. In memory is where their tiles stand in the file, 8 bytes a tile of 256 nodes.
class MapBatches {
 public:
  MapBatches(const CoarseGraining& graining, std::shared_ptr<ScratchFile> file);
  /// Batches in order of time.
  void put_away(const MapSums& sums, const DisplacementSums& displacements);

  const CoarseGraining& graining() const { return graining_; }
  std::size_t size() const { return batches_.size(); }
  const MapShare& share(std::size_t batch) const { return batches_[batch].share; }
  MapShare total() const { return total_; }
  std::size_t pairs() const { return pairs_; }  ///< of snapshots, that displacements were taken from
  double time() const { return time_; }         ///< between the snapshots of the pairs, summed
  /// Rows up to the highest one that a grain reaches: half of a drum is air.
  std::size_t rows_reached() const { return rows_reached_; }
  void read(std::size_t tile, TileOfBatches& sums) const;
  /// Of places and of what the file holds in memory.
  std::size_t bytes_in_memory() const;

 private:
  struct Batch {
    MapShare share;
    StoredTiles<MapNode> nodes;
    std::optional<StoredTiles<double>> area;
    StoredTiles<DisplacementNode> displacements;
  };
  CoarseGraining graining_;
  std::shared_ptr<ScratchFile> file_;
  std::vector<Batch> batches_;
  MapShare total_;
  std::size_t pairs_ = 0, rows_reached_ = 1;
  double time_ = 0;
};

}  // namespace drumlin::particles
