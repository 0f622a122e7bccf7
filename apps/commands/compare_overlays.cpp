#include "apps/commands/compare_overlays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/files/field_map_file.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;

bool any_known(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// Both sides' columns of one field; a band that nobody knows is left out.
void add_columns(ProfileSet& set, const FieldOverlay& field) {
  const auto band = [](const std::vector<double>& ci99) {
    return any_known(ci99) ? ci99 : std::vector<double>();
  };
  set.columns.push_back({field.field + "_particles", field.particles, band(field.ci99)});
  set.columns.push_back({field.field + "_continuum", field.continuum, band(field.continuum_ci99)});
}

ProfileSet compared_columns(const std::vector<FieldComparison>& fields, const std::string& reduced) {
  ProfileSet set;
  set.header = {{"reduced", reduced}};
  for (const FieldComparison& field : fields) {
    set.z = field.overlay.z;
    if (field.overlay.present) add_columns(set, field.overlay);
  }
  return set;
}

}  // namespace

void write_overlays(const fs::path& folder, const ComparedSide& first, const ComparedSide& second,
                    const Comparison& comparison) {
  const std::string reduced = first.profiles.header.at("reduced");
  ProfileSet centre = compared_columns(comparison.fields, reduced);
  const ProfileSet registered = registered_centre(first, second, comparison.registration);
  // What else both sides measured, as it stands: the shear rate with its noise, for one.
  for (const ProfileColumn& column : first.profiles.columns)
    if (registered.find(column.name) != nullptr && centre.find(column.name + "_particles") == nullptr)
      add_columns(centre, overlay(column.name, first.profiles, registered));
  write_profiles(folder / "overlay.csv", centre);
  if (!comparison.slices.part.empty()) fs::create_directories(folder / "overlay_slices");
  for (const SliceComparison& slice : comparison.slices.part) {
    ProfileSet set = compared_columns(slice.fields, reduced);
    set.header["position"] = fmt::format("{}", slice.position);
    set.header["H"] = fmt::format("{}", slice.H);
    write_profiles(folder / "overlay_slices" / fmt::format("x{:+.1f}.csv", slice.position), set);
  }
  if (comparison.maps.missing.empty())
    write_field_map(folder / "overlay_maps.h5",
                    overlaid_maps(*first.fields.maps, *second.fields.maps, comparison.maps.part));
}

}  // namespace drumlin::apps
