#include "apps/commands/measure/maps_part.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/support/json_file.hpp"
#include "coupling/files/field_map_file.hpp"
#include "particles/measurement/intervals.hpp"
#include "particles/measurement/maps/field_maps.hpp"
#include "particles/measurement/maps/map_findings.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr double beyond_the_floor = 1;  // d, of maps without a drum: the kernel of the lowest grains

/// What grows while the snapshots are read.
struct Maps {
  CoarseGraining graining;
  std::optional<MapDepositor> depositor;
  std::vector<MapSums> batches;
  MomentumBalance balance;
  FrictionCollapse collapse;
  LogLine collapse_ci99;  ///< half widths for the invariants' line
};

void begin(const MeasurementFrame& place, const MeasureOptions& options, Maps& maps) {
  const double rim = place.container_radius > 0 ? 0 : beyond_the_floor;
  const bool periodic = place.period > 0;
  maps.graining = coarse_graining(place.frame, periodic ? 0 : place.x_min - rim,
                                  periodic ? place.period : place.x_max + rim, place.z_min - rim,
                                  place.z_max + rim, options.map_spacing, options.map_width, place.period);
  maps.depositor.emplace(maps.graining);
  maps.batches.assign(place.batches, empty_sums(maps.graining));
}

MapBounds bounds_of(const Measurement& measured) {
  const MeasurementFrame& place = measured.place;
  MapBounds bounds;
  bounds.container_radius = place.container_radius;
  bounds.axis_z = -measured.surface_z;
  if (place.container_radius > 0) return bounds;
  bounds.z_min = place.z_min - measured.surface_z;
  if (place.period > 0) return bounds;
  bounds.x_min = place.x_min;
  bounds.x_max = place.x_max;
  return bounds;
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json content_of(const BalanceResidual& r) {
  return {{"nodes", r.nodes},
          {"rms_x", number(r.rms_x)},
          {"rms_z", number(r.rms_z)},
          {"mean_x", number(r.mean_x)},
          {"mean_z", number(r.mean_z)},
          {"noise_x", number(r.noise_x)},
          {"noise_z", number(r.noise_z)},
          {"rms_x_blocks", number(r.rms_x_blocks)},
          {"rms_z_blocks", number(r.rms_z_blocks)},
          {"rms_x_without_kinetic", number(r.rms_x_contact)},
          {"rms_z_without_kinetic", number(r.rms_z_contact)},
          {"rms_inertia", number(r.inertia)}};
}

Json content_of(const LogLine& line) {
  return {{"a", number(line.a)}, {"b", number(line.b)}, {"rms", number(line.rms)}, {"nodes", line.nodes}};
}

/// The fit of mu(I) with one batch left out at a time.
LogLine collapse_intervals(const Measurement& measured, const Maps& maps, const MapBounds& bounds,
                           const MapFindingOptions& limits) {
  LogLine half_widths;
  if (maps.batches.size() < 2) return half_widths;
  MapSums total = maps.batches.front();
  for (std::size_t b = 1; b < maps.batches.size(); ++b) total += maps.batches[b];
  std::vector<double> a, b, rms;
  for (const MapSums& batch : maps.batches) {
    MapSums rest = total;
    rest -= batch;
    const FieldMap map =
        field_maps(maps.graining, {&rest, 1}, measured.place.container_radius, measured.surface_z);
    const LogLine line = friction_collapse(map, bounds, limits, 0).invariant;
    a.push_back(line.a);
    b.push_back(line.b);
    rms.push_back(line.rms);
  }
  half_widths.a = jackknife_ci99(a);
  half_widths.b = jackknife_ci99(b);
  half_widths.rms = jackknife_ci99(rms);
  return half_widths;
}

/// mu_invariant of measured.json.
Json collapse_of(const FrictionCollapse& collapse, const LogLine& ci99) {
  const auto with = [](double value, double half_width) { return to_json(Scalar{"", value, half_width}); };
  return {
      {"a", with(collapse.invariant.a, ci99.a)},
      {"b", with(collapse.invariant.b, ci99.b)},
      {"rms", with(collapse.invariant.rms, ci99.rms)},
      {"noise", number(collapse.noise)},
      {"nodes", collapse.invariant.nodes},
      {"share", number(static_cast<double>(collapse.invariant.nodes) / static_cast<double>(collapse.bulk))},
      {"ratio", content_of(collapse.ratio)}};
}

void write(const Measurement& measured, const PartOutput& output, const MeasureOptions& options, Maps& maps) {
  const MeasurementFrame& place = measured.place;
  FieldMap map = field_maps(maps.graining, maps.batches, place.container_radius, measured.surface_z);
  map.scales = measured.scales;
  map.header = measured.profiles.header;
  // What belongs to the slice of the profiles alone.
  for (const char* key : {"position", "slice_width", "layer_thickness", "wall_z"}) map.header.erase(key);
  map.header["kernel"] = "product of cubic B-splines";
  map.header["kernel_width"] = fmt::format("{}", options.map_width);

  const MapFindingOptions limits;
  const MapBounds bounds = bounds_of(measured);
  maps.balance = momentum_balance(map, bounds, limits, place.batches);
  maps.collapse = friction_collapse(map, bounds, limits, place.batches);
  maps.collapse_ci99 = collapse_intervals(measured, maps, bounds, limits);
  output.content["momentum_balance"] = {{"bulk", content_of(maps.balance.bulk)},
                                        {"flowing", content_of(maps.balance.flowing)},
                                        {"slow", content_of(maps.balance.slow)}};
  output.content["mu_invariant"] = collapse_of(maps.collapse, maps.collapse_ci99);
  output.content["settings"]["maps"] = {{"spacing", options.map_spacing},
                                        {"kernel_width", options.map_width},
                                        {"least_nu", least_map_nu},
                                        {"bulk_margin", limits.margin},
                                        {"block", limits.block},
                                        {"flowing_I", limits.flowing_I},
                                        {"mu_fit_I", {limits.I_min, limits.I_max}}};
  write_field_map(output.folder / "maps.h5", map);
}

void print(const Maps& maps) {
  const auto line = [](const char* zone, const BalanceResidual& r) {
    if (r.nodes == 0) return;
    fmt::print("  {:8} {:.2f}, {:.2f} % along x, z", zone, 100 * r.rms_x, 100 * r.rms_z);
    if (std::isfinite(r.noise_x))
      fmt::print(" (their noise {:.2f}, {:.2f} %)", 100 * r.noise_x, 100 * r.noise_z);
    if (std::isfinite(r.rms_x_blocks))
      fmt::print("; means over {} d {:.2f}, {:.2f} %", MapFindingOptions{}.block, 100 * r.rms_x_blocks,
                 100 * r.rms_z_blocks);
    fmt::print("\n");
  };
  fmt::print("momentum missing at the nodes of the maps, rms over nu g\n");
  line("bulk", maps.balance.bulk);
  line("flowing", maps.balance.flowing);
  line("slow", maps.balance.slow);
  const FrictionCollapse& fits = maps.collapse;
  if (!std::isfinite(fits.invariant.rms)) return;
  fmt::print("mu(I) over the whole bulk\n");
  fmt::print(
      "  |tau|/p             {:.4f} + {:.4f} ln I, rms {:.4f} (noise of mu at a node {:.4f}), {} nodes\n",
      fits.invariant.a, fits.invariant.b, fits.invariant.rms, fits.noise, fits.invariant.nodes);
  fmt::print("  sigma_xz/sigma_zz   {:.4f} + {:.4f} ln I, rms {:.4f}, {} nodes\n", fits.ratio.a, fits.ratio.b,
             fits.ratio.rms, fits.ratio.nodes);
}

}  // namespace

Part maps_part(const MeasureOptions& options) {
  // Refused before the first snapshot is read.
  (void)coarse_graining({}, 0, 1, 0, 1, options.map_spacing, options.map_width, 0);
  auto maps = std::make_shared<Maps>();
  Part part;
  part.name = "maps";
  part.figures = "measure_maps.py";
  part.reading.begin = [maps, options](const MeasurementFrame& place) { begin(place, options, *maps); };
  part.reading.add = [maps](const Snapshot& snapshot, const FlowSnapshot& in_frame, std::size_t batch) {
    maps->depositor->add(snapshot, in_frame, maps->batches[batch]);
  };
  part.write = [maps, options](const Measurement& measured, const PartOutput& output) {
    write(measured, output, options, *maps);
  };
  part.print = [maps] { print(*maps); };
  return part;
}

}  // namespace drumlin::apps
