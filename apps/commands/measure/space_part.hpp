#pragma once
// The layers of spheres with their full tensors, space.csv.
#include "apps/commands/measure/part.hpp"
#include "particles/io/sphere_file.hpp"

namespace drumlin::apps {

/// How the options see spheres. Throws InputError on a slab that is none.
particles::SphereView sphere_view(const MeasureOptions& options);

/// The options with what a run of spheres has in place of absent ones. Throws InputError on a part that only
/// discs have.
MeasureOptions options_for_spheres(MeasureOptions options);

/// Leaves space.csv and the key "spheres" of the settings.
Part space_part(const MeasureOptions& options);

}  // namespace drumlin::apps
