#include "particles/measurement/maps/map_measurement.hpp"

#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/maps/displacement_maps.hpp"

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

/// The fit of mu(I) with one batch left out at a time.
LogLine friction_intervals(const MapReading& reading, double container_radius, double surface_z,
                           const MapBounds& bounds, const MapFindingOptions& limits) {
  LogLine half_widths;
  if (reading.batches.size() < 2) return half_widths;
  std::vector<double> a, b, rms;
  for (std::size_t left_out = 0; left_out < reading.batches.size(); ++left_out) {
    const FieldMap map =
        field_maps_without(left_out, reading.graining, reading.batches, container_radius, surface_z);
    const LogLine line = bulk_friction(map, bounds, limits, 0).invariant;
    a.push_back(line.a);
    b.push_back(line.b);
    rms.push_back(line.rms);
  }
  half_widths.a = jackknife_ci99(a);
  half_widths.b = jackknife_ci99(b);
  half_widths.rms = jackknife_ci99(rms);
  return half_widths;
}

/// Mean time between the snapshots of a pair; 0 without one.
double mean_interval(const std::vector<DisplacementSums>& batches) {
  double time = 0, pairs = 0;
  for (const DisplacementSums& batch : batches) {
    time += batch.time;
    pairs += static_cast<double>(batch.pairs);
  }
  return pairs > 0 ? time / pairs : 0;
}

}  // namespace

MapReading begun_maps(const MeasurementFrame& place, double spacing, double width) {
  const double rim = place.container_radius > 0 ? 0 : beyond_the_floor;
  const bool periodic = place.period > 0;
  MapReading reading;
  reading.graining = coarse_graining(place.frame, periodic ? 0 : place.x_min - rim,
                                     periodic ? place.period : place.x_max + rim, place.z_min - rim,
                                     place.z_max + rim, spacing, width, place.period);
  reading.depositor.emplace(reading.graining);
  reading.batches.assign(place.batches, empty_sums(reading.graining));
  reading.follower.emplace(reading.graining);
  reading.displacements.assign(place.batches, empty_displacements(reading.graining));
  return reading;
}

void add_snapshot(const Snapshot& snapshot, const FlowSnapshot& in_frame, std::size_t batch,
                  MapReading& reading) {
  reading.depositor->add(snapshot, in_frame, reading.batches[batch]);
  reading.follower->add(snapshot, reading.displacements[batch]);
}

MeasuredMaps measured_maps(const MapReading& reading, const MeasurementFrame& place, double surface_z,
                           const MapFindingOptions& limits) {
  const MapBounds bounds = bounds_of(place, surface_z);
  MeasuredMaps result;
  result.map = field_maps(reading.graining, reading.batches, place.container_radius, surface_z);
  add_displacement_fields(reading.graining, reading.displacements, result.map);
  result.displacement_interval = mean_interval(reading.displacements);
  result.balance = momentum_balance(result.map, bounds, limits, place.batches);
  result.friction = bulk_friction(result.map, bounds, limits, place.batches);
  result.friction_ci99 = friction_intervals(reading, place.container_radius, surface_z, bounds, limits);
  return result;
}

}  // namespace drumlin::particles
