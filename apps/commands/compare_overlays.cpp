#include "apps/commands/compare_overlays.hpp"

#include <fmt/format.h>

#include "coupling/comparison/overlay_profiles.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"

namespace drumlin::apps {

void write_overlays(const std::filesystem::path& folder, const coupling::ComparedSide& first,
                    const coupling::ComparedSide& second, const coupling::Comparison& comparison) {
  write_profiles(folder / "overlay.csv", coupling::centre_overlay(first, second, comparison));
  if (!comparison.slices.part.empty()) make_folders(folder / "overlay_slices");
  for (const coupling::SliceComparison& slice : comparison.slices.part)
    write_profiles(folder / "overlay_slices" / fmt::format("x{:+.1f}.csv", slice.position),
                   coupling::slice_overlay(slice, first.profiles.header.reduced.value()));
  if (comparison.maps.missing.empty())
    write_field_map(folder / "overlay_maps.h5",
                    coupling::overlaid_maps(*first.fields.maps, *second.fields.maps, comparison.maps.part));
}

}  // namespace drumlin::apps
