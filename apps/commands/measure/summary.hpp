#pragma once
// What `drumlin measure` prints of a measurement.
#include "particles/measurement/measurement.hpp"

namespace drumlin::apps {

/// The numbers with their intervals (all of them with `verbose`), what was not measured, and whether the run
/// is steady; `with_windows`: beside each what other windows make of it.
void print_summary(const particles::Measurement& measured, const ScalarSet& scalars, bool with_windows,
                   bool verbose);

}  // namespace drumlin::apps
