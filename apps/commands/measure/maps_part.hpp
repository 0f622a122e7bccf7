#pragma once
// The part `maps`: RUN/measured/maps.h5, and what the maps say as a whole in measured.json.
#include "apps/commands/measure/part.hpp"

namespace drumlin::apps {

/// Writes maps.h5, and momentum_balance and mu_invariant of measured.json. Throws InputError when the kernel
/// does not suit the distance of the nodes.
Part maps_part(const MeasureOptions& options);

}  // namespace drumlin::apps
