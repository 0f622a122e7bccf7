// Maps whose sums wait on the disk: bit for bit those of sums in memory, and how much of them is held.
#include <gtest/gtest.h>

#include <bit>

#include "particles/measurement/maps/field_values.hpp"
#include "particles/measurement/maps/map_measurement.hpp"
#include "tests/measurement/collected_maps.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

constexpr double radius = 21;

/// A drum that turns by a little from one to the next, with motions that differ.
std::vector<Snapshot> turning_drum(std::size_t count) {
  std::vector<Snapshot> snapshots;
  for (std::size_t k = 0; k < count; ++k) {
    Snapshot& at = snapshots.emplace_back(testing::filled_drum(radius, 2, 0.3, 0.01));
    at.time = 0.2 * static_cast<double>(k);
    at.wall_angle = 0.01 * at.time;
    for (std::size_t i = 0; i < at.x.size(); ++i) {
      const double phase = 0.37 * static_cast<double>(i * (k + 2) % 101);
      at.v_x[i] += 0.1 * at.z[i] + 0.02 * std::sin(phase);
      at.v_z[i] += 0.02 * std::cos(phase);
      at.x[i] += 1e-3 * at.time * at.z[i];
    }
  }
  return snapshots;
}

MeasurementFrame place_of(std::size_t snapshots, std::size_t batches) {
  MeasurementFrame place;
  place.frame = frame_at_slope(3, -2, 0, -1, 0.3);
  place.container_radius = radius;
  place.reach.x_min = place.reach.z_min = -radius;
  place.reach.x_max = place.reach.z_max = radius;
  place.snapshots = snapshots;
  place.batches = batches;
  return place;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

TEST(StreamedMaps, AreBitForBitThoseOfAllSumsInMemory) {
  const CoarseGraining graining =
      coarse_graining(place_of(1, 1).frame, -radius, radius, -radius, radius, 0.5, 1, 0);
  const std::vector<MapSums> sums = testing::sums_of_snapshots(graining, turning_drum(5));
  const MapBatches batches = testing::batches_of(graining, sums);
  const auto snapshots = batches.snapshots();
  const auto known = known_fields(snapshots.whole);
  const std::size_t mu = static_cast<std::size_t>(
      std::find_if(known.begin(), known.end(), [](auto& one) { return one.value == &MapValues::mu; }) -
      known.begin());
  std::size_t compared = 0, next_row = 0;
  each_map_rows(batches, 0, [&](const MapRows& rows) {
    EXPECT_EQ(rows.first_row, next_row);
    next_row += rows.rows;
    for (std::size_t at = 0; at < rows.rows * graining.grid.columns; ++at) {
      const std::size_t node = rows.first_row * graining.grid.columns + at;
      std::vector<MapNode> of;
      for (const MapSums& one : sums) of.push_back(one.nodes[node]);
      const LeaveOneOut<MapNode> nodes = leave_one_out(of);
      const MapValues whole = values_at(nodes.whole, snapshots.whole, 1);
      for (std::size_t f = 0; f < known.size(); ++f)
        if (!known[f].displaced) {
          ASSERT_TRUE(same_bits(rows.fields[f].value[at], whole.*known[f].value)) << known[f].name;
        }
      std::vector<double> without;
      for (std::size_t b = 0; b < sums.size(); ++b) {
        const MapValues one = values_at(nodes.without[b], snapshots.without[b], 1);
        ASSERT_TRUE(same_bits(rows.without[b][at].I, one.I));
        without.push_back(one.mu);
      }
      ASSERT_TRUE(same_bits(rows.fields[mu].ci99[at], jackknife_ci99(without)));
      compared += std::isfinite(whole.mu) ? 1 : 0;
    }
  });
  EXPECT_EQ(next_row, map_grid(batches, 0).rows);
  EXPECT_GT(compared, 500u);
}

/// Bytes of the reading in memory, most at any time.
std::size_t most_bytes(std::size_t snapshots, std::size_t batches) {
  MapReading reading = begun_maps(place_of(snapshots, batches), 1, 1, std::make_shared<ScratchFile>());
  const std::vector<Snapshot> some = turning_drum(4);
  std::size_t most = 0;
  for (std::size_t s = 0; s < snapshots; ++s) {
    Snapshot snapshot = some[s % some.size()];
    snapshot.time = static_cast<double>(s);
    add_snapshot(snapshot, in_flow_frame(snapshot, reading.graining.frame), batch_of(s, snapshots, batches),
                 reading);
    most = std::max(most, reading.bytes_in_memory());
  }
  return most;
}

TEST(StreamedMaps, HoldTheSumsOfOneBatchWhateverTheNumberOfSnapshots) {
  const MapReading empty = begun_maps(place_of(1, 1), 1, 1, std::make_shared<ScratchFile>());
  const std::size_t tiles = empty.sums.nodes.tiles();
  const std::size_t once = most_bytes(4, 1), many = most_bytes(80, 20);
  // 392 bytes a node of each tile, and per batch where its tiles stand: 8 bytes a tile.
  EXPECT_LE(once, tiles * NodeTiles<MapNode>::nodes_per_tile * 392 + tiles * 64);
  EXPECT_LE(many, once + 20 * tiles * 8);
  EXPECT_EQ(most_bytes(160, 20), many);
}

}  // namespace
}  // namespace drumlin
