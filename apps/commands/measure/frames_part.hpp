#pragma once
// Profiles in frames of one's own: rings about a point, the height and the width of a silo.
#include "apps/commands/measure/part.hpp"

namespace drumlin::apps {

/// Whether the options ask for one of them.
bool asks_for_frames(const MeasureOptions& options);

/// Leaves radial.csv, height.csv and width.csv, as far as they are asked for. Throws InputError on a value
/// that is no place.
Part frames_part(const MeasureOptions& options);

}  // namespace drumlin::apps
