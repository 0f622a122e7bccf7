#pragma once
// Maps of a few snapshots, put together from the rows that they are handed out in.
#include <memory>
#include <vector>

#include "coupling/core/files/scratch_file.hpp"
#include "coupling/core/results/field_map.hpp"
#include "particles/measurement/maps/displacement_sums.hpp"
#include "particles/measurement/maps/field_maps.hpp"

namespace drumlin::testing {

/// The sums of snapshots in order of time.
inline std::vector<particles::MapSums> sums_of_snapshots(const particles::CoarseGraining& graining,
                                                         const std::vector<particles::Snapshot>& snapshots) {
  std::vector<particles::MapSums> result;
  particles::DisplacementDepositor follower(graining);
  for (const particles::Snapshot& snapshot : snapshots) {
    result.push_back(particles::empty_sums(graining));
    add_snapshot(graining, snapshot, in_flow_frame(snapshot, graining.frame), result.back());
    follower.add(snapshot, result.back());
  }
  return result;
}

inline particles::MapBatches batches_of(const particles::CoarseGraining& graining,
                                        const std::vector<particles::MapSums>& sums) {
  particles::MapBatches batches(graining, std::make_shared<ScratchFile>());
  for (const particles::MapSums& one : sums) batches.put_away(one);
  return batches;
}

/// Maps of snapshots in order of time, each in a batch of its own.
inline FieldMap collected_maps(const particles::CoarseGraining& graining,
                               const std::vector<particles::Snapshot>& snapshots, double radius = 0) {
  const particles::MapBatches batches = batches_of(graining, sums_of_snapshots(graining, snapshots));
  FieldMap map;
  map.grid = particles::map_grid(batches, 0);
  particles::each_map_rows(batches, radius, [&](const particles::MapRows& rows) {
    map.fields.resize(rows.fields.size());
    for (std::size_t f = 0; f < rows.fields.size(); ++f) {
      const MapField& from = rows.fields[f];
      MapField& field = map.fields[f];
      field.name = from.name;
      field.value.insert(field.value.end(), from.value.begin(), from.value.end());
      field.ci99.insert(field.ci99.end(), from.ci99.begin(), from.ci99.end());
    }
  });
  return map;
}

/// Calls check(x, z, value of a field by its name) at every node where inside(x, z); returns how many.
template <class Inside, class Check>
int each_node(const FieldMap& map, Inside inside, Check check) {
  int checked = 0;
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
    const double x = map.grid.x_of(node % map.grid.columns), z = map.grid.z_of(node / map.grid.columns);
    if (!inside(x, z)) continue;
    ++checked;
    check(x, z, [&](const char* name) { return map.field(name).value[node]; });
  }
  return checked;
}

}  // namespace drumlin::testing
