#pragma once
// `--grains LIST`: RUN/measured/grains/NNNNNN.h5 for each snapshot of the list, and grains.png of the last of
// them.
#include "apps/commands/measure/part.hpp"

namespace drumlin::apps {

/// Throws InputError when the list names a snapshot that is not there.
Part grains_part(const MeasureOptions& options);

}  // namespace drumlin::apps
