#pragma once
// What measured runs say of the law, before any form is fitted.
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "coupling/calibration/law_points.hpp"
#include "coupling/core/results/field_map.hpp"
#include "coupling/core/results/profile_set.hpp"
#include "coupling/core/results/scalar_set.hpp"

namespace drumlin::coupling {

/// Where the points of a law come from: tensors of maps, or layers of profiles.
enum class EvidenceSource { maps, profiles };
constexpr auto names_of(EvidenceSource) { return std::array{"maps", "profiles"}; }

/// Points of one run.
struct RunEvidence {
  std::string name;
  double rotation_rpm = 0;
  Scalar nu{"nu_bulk", std::nan(""), {}};  ///< volume fraction of the bulk; of runs that are fitted
  bool reduced = false;                    ///< a small (smoke) run
  std::vector<LawBlock> blocks = {};       ///< of maps; empty when profiles are the source
  std::vector<FrictionPoint> layers = {};  ///< of profiles: mu, I
  std::vector<FrictionPoint> ratios = {};  ///< of profiles: k in the place of mu, I
  bool in_layers = false;                  ///< a shear cell or a chute: its layers share one I, nearly
};

/// Range of inertial numbers that points are taken from; absent: that of BlockSelection or LayerSelection.
struct InertialSelection {
  std::optional<double> I_min, I_max;
};

/// Blocks of a map (law_points()). Throws InputError as law_points().
void add_blocks(RunEvidence& run, const FieldMap& map, const InertialSelection& range);

/// Layers of a profile (friction_points()) with mu and with k. Without a drum: 4 d from wall and surface,
/// which may be a wall too, and up to I = 1. Throws InputError where a column is missing.
void add_layers(RunEvidence& run, const ProfileSet& profiles, const InertialSelection& range);

}  // namespace drumlin::coupling
