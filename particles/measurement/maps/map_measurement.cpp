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
  bounds.z_min = place.z_min - surface_z;
  if (place.period > 0) return bounds;
  bounds.x_min = place.x_min;
  bounds.x_max = place.x_max;
  return bounds;
}

/// Half widths from the fits of mu(I) with one batch left out at a time.
LogLine friction_intervals(const std::vector<FrictionLine>& without) {
  LogLine half_widths;
  if (without.size() < 2) return half_widths;
  std::vector<double> a, b, rms;
  for (const FrictionLine& one : without) {
    const LogLine line = one.line();
    a.push_back(line.a);
    b.push_back(line.b);
    rms.push_back(line.rms);
  }
  half_widths.a = jackknife_ci99(a);
  half_widths.b = jackknife_ci99(b);
  half_widths.rms = jackknife_ci99(rms);
  return half_widths;
}

/// The fields that findings read, without a row so far.
FieldMap map_to_keep(const MapGrid& grid, bool with_intervals) {
  FieldMap map;
  map.grid = grid;
  for (const FindingField& wanted : fields_of_findings()) {
    MapField& field = map.fields.emplace_back();
    field.name = wanted.name;
    field.value.reserve(grid.nodes());
    if (with_intervals && wanted.with_intervals) field.ci99.reserve(grid.nodes());
  }
  return map;
}

void keep(const MapRows& rows, FieldMap& map) {
  for (std::size_t f = 0; f < map.fields.size(); ++f) {
    MapField& field = map.fields[f];
    const auto from = std::find_if(rows.fields.begin(), rows.fields.end(),
                                   [&](const MapField& one) { return one.name == field.name; });
    field.value.insert(field.value.end(), from->value.begin(), from->value.end());
    if (fields_of_findings()[f].with_intervals)
      field.ci99.insert(field.ci99.end(), from->ci99.begin(), from->ci99.end());
  }
}

void add_rows(const MapRows& rows, std::size_t columns, std::vector<FrictionLine>& without) {
  for (std::size_t b = 0; b < without.size(); ++b) {
    const FrictionRows& from = rows.without[b];
    for (std::size_t at = 0; at < from.nu.size(); ++at)
      without[b].add(rows.first_row * columns + at, from.nu[at], from.p[at], from.I[at], from.mu[at]);
  }
}

void put_away(MapReading& reading) {
  reading.batches->put_away(reading.sums, reading.displacements);
  reading.sums = empty_sums(reading.graining);
  reading.displacements = empty_displacements(reading.graining);
  ++reading.batch;
}

}  // namespace

std::size_t MapReading::bytes_in_memory() const {
  return sums.nodes.bytes() + (sums.area ? sums.area->bytes() : 0) + displacements.nodes.bytes() +
         batches->bytes_in_memory();
}

MapReading begun_maps(const MeasurementFrame& place, double spacing, double width,
                      std::shared_ptr<ScratchFile> file) {
  const double rim = place.container_radius > 0 || place.closed ? 0 : beyond_the_floor;
  const bool periodic = place.period > 0;
  MapReading reading;
  reading.graining = coarse_graining(place.frame, periodic ? 0 : place.x_min - rim,
                                     periodic ? place.period : place.x_max + rim, place.z_min - rim,
                                     place.z_max + rim, spacing, width, place.period, place.closed);
  reading.depositor.emplace(reading.graining);
  reading.follower.emplace(reading.graining);
  reading.sums = empty_sums(reading.graining);
  reading.displacements = empty_displacements(reading.graining);
  reading.file = std::move(file);
  reading.batches.emplace(reading.graining, reading.file);
  return reading;
}

void add_snapshot(const Snapshot& snapshot, const FlowSnapshot& in_frame, std::size_t batch,
                  MapReading& reading) {
  while (reading.batch < batch) put_away(reading);
  reading.depositor->add(snapshot, in_frame, reading.sums);
  reading.follower->add(snapshot, reading.displacements);
}

MeasuredMaps measured_maps(MapReading reading, const MeasurementFrame& place, double surface_z,
                           const MapFindingOptions& limits, const MapRowSink& sink) {
  put_away(reading);
  reading.depositor.reset();
  reading.follower.reset();
  const MapBatches& batches = *reading.batches;
  const MapBounds bounds = bounds_of(place, surface_z);
  const MapGrid grid = map_grid(batches, surface_z);
  FieldMap kept = map_to_keep(grid, batches.size() > 1);
  std::vector<FrictionLine> without;
  for (std::size_t b = 0; b < batches.size() && batches.size() > 1; ++b)
    without.emplace_back(grid, bounds, limits, reading.file);
  each_map_rows(batches, place.container_radius, [&](const MapRows& rows) {
    sink(grid, rows);
    keep(rows, kept);
    add_rows(rows, grid.columns, without);
  });
  MeasuredMaps result;
  if (batches.pairs() > 0)
    result.displacement_interval = batches.time() / static_cast<double>(batches.pairs());
  result.balance = momentum_balance(kept, bounds, limits, place.batches);
  result.friction = bulk_friction(kept, bounds, limits, place.batches);
  result.friction_ci99 = friction_intervals(without);
  return result;
}

}  // namespace drumlin::particles
