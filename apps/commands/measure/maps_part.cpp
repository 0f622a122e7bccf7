#include "apps/commands/measure/maps_part.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/support/json_file.hpp"
#include "coupling/files/field_map_file.hpp"
#include "particles/measurement/field_maps.hpp"
#include "particles/measurement/map_findings.hpp"

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

Json to_json(const BalanceResidual& r) {
  return {{"nodes", r.nodes},
          {"rms_x", number(r.rms_x)},
          {"rms_z", number(r.rms_z)},
          {"mean_x", number(r.mean_x)},
          {"mean_z", number(r.mean_z)},
          {"noise_x", number(r.noise_x)},
          {"noise_z", number(r.noise_z)},
          {"rms_x_without_kinetic", number(r.rms_x_contact)},
          {"rms_z_without_kinetic", number(r.rms_z_contact)},
          {"rms_inertia", number(r.inertia)}};
}

Json to_json(const LogLine& line) {
  return {{"a", number(line.a)}, {"b", number(line.b)}, {"rms", number(line.rms)}, {"nodes", line.nodes}};
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
  maps.collapse = friction_collapse(map, bounds, limits);
  output.content["momentum_balance"] = {{"bulk", to_json(maps.balance.bulk)},
                                        {"flowing", to_json(maps.balance.flowing)},
                                        {"slow", to_json(maps.balance.slow)}};
  output.content["mu_invariant"] = to_json(maps.collapse.invariant);
  output.content["mu_invariant"]["share"] =
      static_cast<double>(maps.collapse.invariant.nodes) / static_cast<double>(maps.collapse.bulk);
  output.content["mu_invariant"]["ratio"] = to_json(maps.collapse.ratio);
  output.content["settings"]["maps"] = {
      {"spacing", options.map_spacing}, {"kernel_width", options.map_width},
      {"least_nu", least_map_nu},       {"bulk_margin", limits.margin},
      {"flowing_I", limits.flowing_I},  {"mu_fit_I", {limits.I_min, limits.I_max}}};
  write_field_map(output.folder / "maps.h5", map);
}

void print(const Maps& maps) {
  const auto line = [](const char* zone, const BalanceResidual& r) {
    if (r.nodes == 0) return;
    fmt::print("  {:8} {:.2f} % along x, {:.2f} % along z (noise of the mean {:.2f} %, {:.2f} %), {} nodes\n",
               zone, 100 * r.rms_x, 100 * r.rms_z, 100 * r.noise_x, 100 * r.noise_z, r.nodes);
  };
  fmt::print("momentum missing in the maps, rms over nu g\n");
  line("bulk", maps.balance.bulk);
  line("flowing", maps.balance.flowing);
  line("slow", maps.balance.slow);
  const auto law = [](const char* name, const LogLine& fit) {
    if (std::isfinite(fit.rms))
      fmt::print("  {:19} {:.4f} + {:.4f} ln I, rms {:.4f}, {} nodes\n", name, fit.a, fit.b, fit.rms,
                 fit.nodes);
  };
  fmt::print("mu(I) over the whole bulk\n");
  law("|tau|/p", maps.collapse.invariant);
  law("sigma_xz/sigma_zz", maps.collapse.ratio);
}

}  // namespace

Part maps_part(const MeasureOptions& options) {
  // Refused before the first snapshot is read.
  (void)coarse_graining({}, 0, 1, 0, 1, options.map_spacing, options.map_width, 0);
  auto maps = std::make_shared<Maps>();
  Part part;
  part.name = "maps";
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
