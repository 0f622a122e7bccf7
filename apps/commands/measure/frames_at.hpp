#pragma once
// `drumlin measure RUN... --at TIMES -o DIR`: frames.h5 of several runs side by side
// (docs/formats/frames.md).
#include "apps/commands/measure/measure.hpp"

namespace drumlin::apps {

/// Throws InputError on a value that is no time or range, a run in a periodic domain, or runs of scenes with
/// other units or walls.
int measure_frames(const MeasureOptions& options);

}  // namespace drumlin::apps
