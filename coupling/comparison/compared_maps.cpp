#include <cmath>

#include "coupling/comparison/map_sampling.hpp"
#include "coupling/comparison/parts.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/quantities.hpp"

namespace drumlin::coupling {

namespace {

constexpr double surface_nu = 0.7, flowing_I = 0.01;

/// One field of both sides at the nodes of the first.
FieldOverlay map_overlay(const std::string& field, const FieldMap& first, const FieldMap& second) {
  const FieldValues ours = map_field(field, first), theirs = map_field(field, second);
  const std::vector<double> lost(theirs.noise.begin(), theirs.noise.end());
  FieldOverlay result{
      field, {}, {}, ours.value, ours.ci99, {}, {}, ours.noise, ours.present && theirs.present};
  for (std::size_t node = 0; node < first.grid.nodes(); ++node) {
    const double x = first.grid.x_of(node % first.grid.columns);
    const double z = first.grid.z_of(node / first.grid.columns);
    result.x.push_back(x);
    result.z.push_back(z);
    result.continuum.push_back(bilinear(second.grid, theirs.value, x, z));
    result.continuum_ci99.push_back(bilinear(second.grid, theirs.ci99, x, z));
    if (bilinear(second.grid, lost, x, z) > 0) result.noise[node] = 1;
  }
  return result;
}

}  // namespace

std::vector<MapZone> map_zones(const FieldMap& map, const ZoneOptions& options) {
  const double radius = number_or_nan(map.header, &RunHeader::drum_radius);
  const double axis = number_or_nan(map.header, &RunHeader::axis_depth);
  const double third = std::sqrt(radius * radius - axis * axis) / 3;
  const std::vector<double> surface = surface_heights(map.grid, map.field("nu").value, surface_nu);
  const auto& I = map.field("I").value;
  std::vector<MapZone> zones{{"flowing", {}}, {"static", {}},     {"upstream", {}},
                             {"middle", {}},  {"downstream", {}}, {"all", {}}};
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
    const std::size_t column = node % map.grid.columns;
    const double x = map.grid.x_of(column), z = map.grid.z_of(node / map.grid.columns);
    if (!(surface[column] - z >= options.surface_margin)) continue;
    if (!(radius - std::hypot(x, z - axis) >= options.wall_margin)) continue;
    zones[5].nodes.push_back(node);
    if (std::isfinite(I[node])) zones[I[node] >= flowing_I ? 0 : 1].nodes.push_back(node);
    zones[x < -third ? 2 : x <= third ? 3 : 4].nodes.push_back(node);
  }
  return zones;
}

FieldMap overlaid_maps(const FieldMap& first, const FieldMap& second, const MapComparison& comparison) {
  FieldMap result{first.grid, {}, first.header, first.scales};
  const FieldMap theirs = moved(second, comparison.offset);
  const std::size_t nodes = first.grid.nodes();
  for (const std::string& compared : compared_fields()) {
    const std::string name = name_in_maps(compared);
    if (first.find(name) == nullptr || theirs.find(name) == nullptr) continue;
    FieldOverlay both = map_overlay(name, first, theirs);
    if (period_of(name) > 0) {  // as it stands, noise included
      both.particles = first.field(name).value;
      both.ci99 = first.field(name).ci99;
    }
    result.fields.push_back({name + "_particles", both.particles, both.ci99});
    result.fields.push_back({name + "_continuum", both.continuum, both.continuum_ci99});
  }
  MapField zone{"zone", std::vector<double>(nodes, 0), {}}, noise{"noise", std::vector<double>(nodes, 0), {}};
  for (std::size_t kind : {1u, 0u})
    for (const std::size_t node : comparison.zones[kind].nodes) zone.value[node] = kind == 0 ? 2 : 1;
  for (const FieldComparison& field : comparison.fields)
    if (field.overlay.field == "log10_shear_rate")
      noise.value.assign(field.overlay.noise.begin(), field.overlay.noise.end());
  result.fields.push_back(std::move(zone));
  result.fields.push_back(std::move(noise));
  return result;
}

PartOrReason<MapComparison> compared_maps(const SideFields& first, const SideFields& second, Registration by,
                                          const ZoneOptions& options) {
  if (!first.maps) return {{}, "the first side has no maps"};
  if (!second.maps) return {{}, "the second side has no maps"};
  PartOrReason<MapComparison> result;
  MapComparison& maps = result.part;
  maps.grid = first.maps->grid;
  maps.offset = registration_offset(first.maps->header, second.maps->header, by);
  maps.zones = map_zones(*first.maps, options);
  const FieldMap theirs = moved(*second.maps, maps.offset);
  for (const std::string& field : compared_fields()) {
    FieldComparison comparison{map_overlay(field, *first.maps, theirs), {}};
    for (const MapZone& zone : maps.zones) {
      const Zone named{zone.name, no_value, no_value};
      comparison.zones.push_back({named, errors_at(comparison.overlay, zone.nodes)});
    }
    maps.fields.push_back(std::move(comparison));
  }
  return result;
}

}  // namespace drumlin::coupling
