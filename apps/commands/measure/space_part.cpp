#include "apps/commands/measure/space_part.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "coupling/core/basics/errors.hpp"
#include "particles/measurement/layers/variants.hpp"
#include "particles/measurement/spheres/space_layers.hpp"

namespace drumlin::apps {

particles::SphereView sphere_view(const MeasureOptions& options) {
  particles::SphereView view;
  for (const particles::SeenAlong axis :
       {particles::SeenAlong::x, particles::SeenAlong::y, particles::SeenAlong::z})
    if (options.along == name_of(axis)) view.along = axis;
  if (options.slab.empty()) return view;
  if (options.slab.size() != 2 || !(options.slab[0] < options.slab[1]))
    throw InputError("--slab: takes two numbers in d, the second one greater");
  view.slab = {options.slab[0], options.slab[1]};
  return view;
}

MeasureOptions options_for_spheres(MeasureOptions options) {
  if (!options.grains.empty())
    throw InputError("--grains: the run is one of spheres, whose grains have no cells in a plane");
  for (const char* name : {"voronoi", "forces"})
    if (!options.parts.empty() && names_part(options, name))
      throw InputError(
          fmt::format("--parts: {}: the run is one of spheres (allowed: gradients, slices, "
                      "sensitivity, maps, none)",
                      name));
  if (options.parts.empty()) options.parts = {"gradients", "slices", "sensitivity", "maps"};
  return options;
}

Part space_part(const MeasureOptions& options) {
  auto layers = std::make_shared<std::optional<particles::SpaceLayers>>();
  auto depth = std::make_shared<double>(0);
  Part part;
  part.name = "space";
  part.reading.begin = [=](const particles::MeasurementFrame& place) {
    *layers = particles::empty_space_layers(
        particles::slice_grid(place, options.position, place.slice_width, options.layer_thickness),
        place.batches);
  };
  part.reading.add = [=](const particles::Snapshot& snapshot, const particles::FlowSnapshot& in_frame,
                         std::size_t batch) {
    add_snapshot((*layers)->grid, snapshot, in_frame, (*layers)->batches[batch]);
    *depth = in_frame.depth;
  };
  part.write = [=](const particles::Measurement& measured, const PartOutput& output) {
    ProfileSet profiles = particles::space_profiles(**layers, measured.surface_z);
    profiles.header = measured.profiles.header;
    write_profiles(output.folder / "space.csv", profiles);
    output.content["settings"]["spheres"] = {
        {"seen_along", options.along}, {"slab", options.slab}, {"depth", *depth}};
  };
  return part;
}

}  // namespace drumlin::apps
