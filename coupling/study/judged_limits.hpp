#pragma once
// Flows of several speeds judged by limits, each against all runs of its speed that calibrated nothing, with
// the noise floor, seed against seed, in each cell.
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coupling/comparison/comparison.hpp"
#include "coupling/study/limits.hpp"

namespace drumlin::coupling {

/// A run or a flow with its maps, where it has them.
struct JudgedSide {
  std::string name;
  double rotation_rpm = 0;
  ComparedSide side;
  double cpu_seconds = std::numeric_limits<double>::quiet_NaN();
  std::string start;  ///< of a flow: "cold", "neighbour", ...
};

/// One limit at one speed.
struct LimitCell {
  double rotation_rpm = 0;
  /// Error of the flow, mean over the runs (of a scalar the mean of the signed differences, without its sign;
  /// of inside_interval that over the half width of the pooled interval); NaN where it cannot be told.
  double value = std::numeric_limits<double>::quiet_NaN();
  /// The same between two runs of the speed, mean over the pairs; with one run that of the other speeds'; NaN
  /// where no speed has two runs.
  double floor = std::numeric_limits<double>::quiet_NaN();
  bool floor_of_others = false;
  double limit = 0;  ///< must, or floor_factor floors where that is more
  bool met = false;
  bool undefined = false;  ///< the flow leaves places of the zone undefined: missed
};

struct LimitRow {
  Limit limit;
  Registration registration = Registration::axis;
  std::vector<LimitCell> cells;  ///< ascending speeds
  Target::Outcome must = Target::Outcome::not_measured, aim = Target::Outcome::not_measured;
};

struct JudgedLimits {
  std::vector<double> speeds;          ///< rpm, ascending: those with a flow and a run
  std::vector<std::string> judged_by;  ///< runs
  std::vector<std::string>
      calibrated_by;           ///< runs of the law that are judges all the same: the speed has no other
  std::vector<LimitRow> rows;  ///< all by the axis, then all by the surface
};

/// Runs named in `fitted_on` judge only where their speed has no other. Throws InputError where a side shows
/// another drum.
JudgedLimits judged_limits(const Limits& limits, const std::vector<JudgedSide>& runs,
                           const std::vector<JudgedSide>& flows, const std::set<std::string>& fitted_on);

/// Shear over normal traction on circles about the drum's axis, 5, 7, 9 and 11 d inside the wall (mean of the
/// four), at -45, -40 ... 45 deg from below the axis, positive downslope; NaN where a map does not reach. The
/// map needs sigma_xx, sigma_zz, sigma_xz, axis_depth and drum_radius (InputError).
std::vector<double> traction_ratios(const FieldMap& map);

}  // namespace drumlin::coupling
