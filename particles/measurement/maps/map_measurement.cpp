#include "particles/measurement/maps/map_measurement.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

constexpr double beyond_the_floor = 1;  // d, of maps without a drum: the kernel of the lowest grains

MapBounds bounds_of(const MeasurementFrame& place, double surface_z) {
  MapBounds bounds;
  bounds.container_radius = place.container_radius;
  bounds.axis_z = -surface_z;
  if (place.container_radius > 0) return bounds;
  bounds.z_min = place.reach.z_min - surface_z;
  if (place.period > 0) return bounds;
  bounds.x_min = place.reach.x_min;
  bounds.x_max = place.reach.x_max;
  return bounds;
}

/// Nodes of all maps without one batch each, in the order of their rows.
using NodesWithout = std::vector<ScratchList<FrictionNode>>;

/// Half widths from the fits of mu(I) with one batch left out at a time.
LogLine friction_intervals(const MapGrid& grid, const NodesWithout& without, const MapBounds& bounds,
                           const MapFindingOptions& limits) {
  LeaveOneOut<LogLine> lines;
  for (const auto& nodes : without) {
    FindingMap map{grid, {}};
    nodes.each([&](const FrictionNode& node) { map.nodes.push_back({node}); });
    lines.without.push_back(bulk_friction(map, bounds, limits, 0).invariant);
  }
  return {ci99_of(lines, &LogLine::a), ci99_of(lines, &LogLine::b), ci99_of(lines, &LogLine::rms)};
}

void put_away(MapReading& reading) {
  reading.batches->put_away(reading.sums);
  reading.sums = empty_sums(reading.graining);
  ++reading.batch;
}

}  // namespace

std::size_t MapReading::bytes_in_memory() const {
  return sums.nodes.bytes() + sums.space.bytes() + batches->bytes_in_memory();
}

MapReading begun_maps(const MeasurementFrame& place, double spacing, double width,
                      std::shared_ptr<ScratchFile> file) {
  const double rim = place.container_radius > 0 || place.closed ? 0 : beyond_the_floor;
  const bool periodic = place.period > 0;
  MapReading reading;
  reading.graining = coarse_graining(
      place.frame, periodic ? 0 : place.reach.x_min - rim, periodic ? place.period : place.reach.x_max + rim,
      place.reach.z_min - rim, place.reach.z_max + rim, spacing, width, place.period, place.closed);
  reading.follower.emplace(reading.graining);
  reading.sums = empty_sums(reading.graining);
  reading.file = std::move(file);
  reading.batches.emplace(reading.graining, reading.file);
  return reading;
}

void add_snapshot(const Snapshot& snapshot, const FlowSnapshot& in_frame, std::size_t batch,
                  MapReading& reading) {
  while (reading.batch < batch) put_away(reading);
  add_snapshot(reading.graining, snapshot, in_frame, reading.sums);
  reading.follower->add(snapshot, reading.sums);
}

MeasuredMaps measured_maps(MapReading reading, const MeasurementFrame& place, double surface_z,
                           const MapFindingOptions& limits, const MapRowSink& sink) {
  put_away(reading);
  reading.follower.reset();
  const MapBatches& batches = *reading.batches;
  const MapBounds bounds = bounds_of(place, surface_z);
  const MapGrid grid = map_grid(batches, surface_z);
  FindingMap selected{grid, {}};
  selected.nodes.reserve(grid.nodes());
  NodesWithout without;
  for (std::size_t b = 0; b < batches.size() && batches.size() > 1; ++b) without.emplace_back(reading.file);
  each_map_rows(batches, place.container_radius, [&](const MapRows& rows) {
    sink(grid, rows);
    selected.nodes.insert(selected.nodes.end(), rows.nodes.begin(), rows.nodes.end());
    for (std::size_t b = 0; b < without.size(); ++b)
      for (const FrictionNode& node : rows.without[b]) without[b].push_back(node);
  });
  MeasuredMaps result;
  if (const auto whole = batches.snapshots().whole; whole.pairs > 0)
    result.displacement_interval = whole.time / whole.pairs;
  result.balance = momentum_balance(selected, bounds, limits, place.batches);
  result.friction = bulk_friction(selected, bounds, limits, place.batches);
  result.friction_ci99 = friction_intervals(grid, without, bounds, limits);
  return result;
}

}  // namespace drumlin::particles
