#include "coupling/comparison/overlay_profiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumlin::coupling {

namespace {

bool any_known(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// Both sides' columns of one field; an interval without a single number is no column.
void add_columns(ProfileSet& set, const FieldOverlay& field) {
  const auto band = [](const std::vector<double>& ci99) {
    return any_known(ci99) ? ci99 : std::vector<double>();
  };
  set.columns.push_back({field.field + "_particles", field.particles, band(field.ci99)});
  set.columns.push_back({field.field + "_continuum", field.continuum, band(field.continuum_ci99)});
}

}  // namespace

ProfileSet compared_columns(const std::vector<FieldComparison>& fields, bool reduced) {
  ProfileSet set;
  set.header.reduced = reduced;
  for (const FieldComparison& field : fields) {
    set.z = field.overlay.z;
    if (field.overlay.present) add_columns(set, field.overlay);
  }
  return set;
}

ProfileSet centre_overlay(const ComparedSide& first, const ComparedSide& second,
                          const Comparison& comparison) {
  ProfileSet centre = compared_columns(comparison.fields, first.profiles.header.reduced.value());
  const ProfileSet registered = registered_centre(first, second, comparison.registration);
  // What else both sides measured, as it stands: the shear rate with its noise, for one.
  for (const ProfileColumn& column : first.profiles.columns)
    if (registered.find(column.name) != nullptr && centre.find(column.name + "_particles") == nullptr)
      add_columns(centre, overlay(column.name, first.profiles, registered));
  return centre;
}

ProfileSet slice_overlay(const SliceComparison& slice, bool reduced) {
  ProfileSet set = compared_columns(slice.fields, reduced);
  set.header.position = slice.position;
  set.header.H = std::isfinite(slice.H) ? slice.H : std::numeric_limits<double>::quiet_NaN();
  return set;
}

}  // namespace drumlin::coupling
