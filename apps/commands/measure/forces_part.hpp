#pragma once
// Distribution and anisotropy of contact forces as a part of `drumlin measure` (docs/formats/measured.md).
#include "apps/commands/measure/part.hpp"

namespace drumlin::apps {

/// Leaves forces.csv, force_distributions.csv and "forces" in measured.json. The coefficients of friction are
/// those of RUN/scene.toml where one pair of them holds for all grains.
Part forces_part(const MeasureOptions& options);

}  // namespace drumlin::apps
