#include <cmath>

#include "coupling/comparison/map_sampling.hpp"
#include "coupling/comparison/parts.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/profile_scalars.hpp"

namespace drumlin::coupling {

namespace {

constexpr double slice_width = 2, same_place = 0.5;  // d

/// Half the chord of the surface, from the header of a map.
double half_chord(const RunHeader& header) {
  const double radius = number_or_nan(header, &RunHeader::drum_radius);
  const double height = number_or_nan(header, &RunHeader::axis_depth);
  return std::sqrt(radius * radius - height * height);
}

/// Layers of 1 d through the whole map.
std::vector<double> layers_of(const MapGrid& grid) {
  std::vector<double> z;
  const double bottom = std::ceil(grid.z_first), top = grid.z_of(grid.rows - 1);
  for (int layer = 0; bottom + layer + 1 <= top; ++layer) z.push_back(bottom + layer + 0.5);
  return z;
}

/// The slices of a side that measured none, through its maps at the places where the measurement puts them.
std::map<double, ProfileSet> slices_of(const SideFields& side) {
  if (!side.slices.empty() || !side.maps) return side.slices;
  std::map<double, ProfileSet> slices;
  const double half = half_chord(side.maps->header);
  for (const double share : {-0.6, -0.3, 0.0, 0.3, 0.6})
    slices[share * half] =
        profile_through(*side.maps, share * half, slice_width, layers_of(side.maps->grid), 1);
  return slices;
}

/// The second side at a place of the first, on the first one's axes.
std::optional<ProfileSet> counterpart(const SideFields& second, const ProfileSet& ours, double position,
                                      Registration by, double& offset) {
  for (const auto& [theirs, profiles] : second.slices)
    if (std::abs(theirs - position) <= same_place) {
      offset = registration_offset(ours.header, profiles.header, by);
      return moved(profiles, offset);
    }
  if (!second.maps) return std::nullopt;
  offset = registration_offset(ours.header, second.maps->header, by);
  const double width = number_or_nan(ours.header, &RunHeader::slice_width);
  const double thickness = number_or_nan(ours.header, &RunHeader::layer_thickness);
  return profile_through(moved(*second.maps, offset), position, std::isfinite(width) ? width : slice_width,
                         ours.z, std::isfinite(thickness) ? thickness : 1);
}

/// The layers of a slice begin above the round wall only where they have grains.
ProfileSet without_empty_bottom(const ProfileSet& slice) {
  const auto& v_x = slice.column("v_x").value;
  std::size_t first = 0;
  while (first < v_x.size() && !std::isfinite(v_x[first])) ++first;
  ProfileSet cut;
  cut.z.assign(slice.z.begin() + static_cast<long>(first), slice.z.end());
  return cut;
}

}  // namespace

PartOrReason<std::vector<SliceComparison>> compared_slices(const SideFields& first, const SideFields& second,
                                                           Registration by, const ZoneOptions& options) {
  PartOrReason<std::vector<SliceComparison>> result;
  const auto slices = slices_of(first);
  if (slices.empty()) result.missing = "the first side has neither slices nor maps";
  for (const auto& [position, ours] : slices) {
    SliceComparison slice{position, profile_scalars(ours).H, no_value, {}};
    const auto theirs = counterpart(second, ours, position, by, slice.offset);
    if (!theirs) {
      result.missing = "the second side has neither slices there nor maps";
      result.part.clear();
      break;
    }
    const auto zones = zones_of(without_empty_bottom(ours), slice.H, options);
    for (const std::string& field : compared_fields()) {
      FieldComparison comparison{overlay(field, ours, *theirs), {}};
      for (const Zone& zone : zones) comparison.zones.push_back({zone, errors_in(comparison.overlay, zone)});
      slice.fields.push_back(std::move(comparison));
    }
    result.part.push_back(std::move(slice));
  }
  return result;
}

}  // namespace drumlin::coupling
