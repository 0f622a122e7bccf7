#pragma once
// What the runs say of the law, before any form is fitted.
#include <optional>
#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "apps/support/measured_run.hpp"
#include "coupling/calibration/law_points.hpp"
#include "coupling/exchange/field_map.hpp"

namespace drumlin::apps {

/// Points of one run.
struct RunEvidence {
  MeasuredRun run;
  double rotation_rpm = 0;
  std::vector<LawBlock> blocks;       ///< of maps.h5; empty when profiles are the source
  std::vector<FrictionPoint> layers;  ///< of profiles.csv: mu, I
  std::vector<FrictionPoint> ratios;  ///< of profiles.csv: k in the place of mu, I
  std::optional<FieldMap> map;        ///< kept for the relaxation of the fabric
};

enum class Source { maps, profiles };

/// maps or profiles, and which for "auto". Throws InputError where maps are asked for and a run has none.
Source source_of(const CalibrateOptions& options);

/// Reads the runs strictly. Throws InputError.
std::vector<RunEvidence> evidence_of(const std::vector<std::filesystem::path>& runs, Source source,
                                     const CalibrateOptions& options);

}  // namespace drumlin::apps
