#pragma once
// The sums of all batches of a run, read back tile after tile.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "coupling/core/files/scratch_file.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/maps/map_sums.hpp"

namespace drumlin::particles {

/// Of the batches put away. In memory is where their tiles stand in the file, 8 bytes a tile of 256 nodes.
class MapBatches {
 public:
  MapBatches(const CoarseGraining& graining, std::shared_ptr<ScratchFile> file);
  /// Batches in order of time.
  void put_away(const MapSums& sums);

  const CoarseGraining& graining() const { return graining_; }
  std::size_t size() const { return places_.size(); }
  LeaveOneOut<MapSums::Snapshots> snapshots() const { return leave_one_out(snapshots_); }
  /// Rows up to the highest one that a grain reaches: half of a drum is air.
  std::size_t rows_reached() const { return rows_reached_; }
  /// The nodes of one tile, batch by batch; none where a batch has nothing but zeros.
  void read(std::size_t tile, std::vector<std::vector<MapNode>>& batches) const;
  void read(std::size_t tile, std::vector<std::vector<SpaceNode>>& batches) const;
  std::size_t bytes_in_memory() const;

 private:
  CoarseGraining graining_;
  std::shared_ptr<ScratchFile> file_;
  std::vector<MapSums::Snapshots> snapshots_;               // of each batch, as what follows
  std::vector<std::vector<std::uint64_t>> places_, space_;  // of its tiles in the file
  std::size_t rows_reached_ = 1;
};

}  // namespace drumlin::particles
