// Maps whose sums wait on the disk: bit for bit those of sums in memory, and how much of them is held.
#include <gtest/gtest.h>

#include <bit>

#include "particles/measurement/frame/intervals.hpp"
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
  place.x_min = place.z_min = -radius;
  place.x_max = place.z_max = radius;
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
  const testing::SumsOfSnapshots sums = testing::sums_of_snapshots(graining, turning_drum(5));
  const MapBatches batches = testing::batches_of(graining, sums);
  MapShare total;
  for (const MapSums& one : sums.sums) total.add(one);
  const auto known = known_fields(total);
  std::size_t compared = 0, next_row = 0;
  each_map_rows(batches, 0, [&](const MapRows& rows) {
    EXPECT_EQ(rows.first_row, next_row);
    next_row += rows.rows;
    for (std::size_t at = 0; at < rows.rows * graining.grid.columns; ++at) {
      const std::size_t node = rows.first_row * graining.grid.columns + at;
      const auto of = [&](std::size_t b) {
        return NodeSums{sums.sums[b].nodes[node], sums.sums[b].area_at(node)};
      };
      NodeSums all = of(0);
      for (std::size_t b = 1; b < sums.sums.size(); ++b) all += of(b);
      const MapValues whole = values_at(all, total, 1);
      for (std::size_t f = 0; f < known.size(); ++f)
        ASSERT_TRUE(same_bits(rows.fields[f].value[at], whole.*known[f].value)) << known[f].name;
      std::vector<double> mu;
      for (std::size_t b = 0; b < sums.sums.size(); ++b) {
        NodeSums rest = all;
        rest -= of(b);
        MapShare share = total;
        share.take(batches.share(b));
        const MapValues without = values_at(rest, share, 1);
        ASSERT_TRUE(same_bits(rows.without[b].I[at], without.I));
        mu.push_back(without.mu);
      }
      const std::size_t field = static_cast<std::size_t>(
          std::find_if(known.begin(), known.end(), [](auto& one) { return one.value == &MapValues::mu; }) -
          known.begin());
      ASSERT_TRUE(same_bits(rows.fields[field].ci99[at], jackknife_ci99(mu)));
      compared += std::isfinite(whole.mu) ? 1 : 0;
    }
  });
  EXPECT_EQ(next_row, map_grid(batches, 0).rows);
  EXPECT_GT(compared, 500u);
}

TEST(StreamedMaps, FitOfFrictionIsThatOfAMapThatIsKept) {
  const CoarseGraining graining =
      coarse_graining(place_of(1, 1).frame, -radius, radius, -radius, radius, 1, 1, 0);
  const FieldMap map = testing::collected_maps(graining, turning_drum(3), radius);
  MapBounds bounds;
  bounds.container_radius = radius;
  MapFindingOptions options;
  options.I_max = 10;
  FrictionLine line(map.grid, bounds, options, std::make_shared<ScratchFile>());
  const auto value = [&](const char* name, std::size_t node) { return map.field(name).value[node]; };
  for (std::size_t node = 0; node < map.grid.nodes(); ++node)
    line.add(node, value("nu", node), value("p", node), value("I", node), value("mu", node));
  const LogLine kept = bulk_friction(map, bounds, options, 3).invariant, streamed = line.line();
  EXPECT_GT(kept.nodes, 100u);
  EXPECT_EQ(streamed.nodes, kept.nodes);
  EXPECT_TRUE(same_bits(streamed.a, kept.a));
  EXPECT_TRUE(same_bits(streamed.b, kept.b));
  EXPECT_TRUE(same_bits(streamed.rms, kept.rms));
}

/// Bytes of the reading itself, most at any time, without what its file holds in memory.
std::size_t most_bytes(std::size_t snapshots, std::size_t batches) {
  MapReading reading = begun_maps(place_of(snapshots, batches), 1, 1, std::make_shared<ScratchFile>());
  FlowSnapshot in_frame;
  const std::vector<Snapshot> some = turning_drum(4);
  std::size_t most = 0;
  for (std::size_t s = 0; s < snapshots; ++s) {
    Snapshot snapshot = some[s % some.size()];
    snapshot.time = static_cast<double>(s);
    to_flow_frame(snapshot, reading.graining.frame, VelocityKind::window, in_frame);
    add_snapshot(snapshot, in_frame, batch_of(s, snapshots, batches), reading);
    EXPECT_LE(reading.file->bytes_in_memory(), ScratchFile::in_memory);
    most = std::max(most, reading.bytes_in_memory() - reading.file->bytes_in_memory());
  }
  return most;
}

TEST(StreamedMaps, HoldTheSumsOfOneBatchWhateverTheNumberOfSnapshots) {
  const MapReading empty = begun_maps(place_of(1, 1), 1, 1, std::make_shared<ScratchFile>());
  const std::size_t tiles = empty.sums.nodes.tiles();
  const std::size_t once = most_bytes(4, 1), many = most_bytes(80, 20);
  // 360 bytes a node of each tile, and per batch where its tiles stand: 8 bytes a tile for each kind of sums.
  EXPECT_LE(once, tiles * NodeTiles<MapNode>::nodes_per_tile * 360 + tiles * 64);
  EXPECT_LE(many, once + 20 * tiles * 2 * 8);
  EXPECT_EQ(most_bytes(160, 20), many);
}

}  // namespace
}  // namespace drumlin
