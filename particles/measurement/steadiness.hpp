#pragma once
// Steadiness of a run: whether it had reached steady flow, and was observed for long enough to tell.
#include <limits>
#include <string>
#include <vector>

#include "particles/measurement/frame/survey.hpp"

namespace drumlin::particles {

/// A change between the first and the second half of the snapshots, with its 99 % half width.
struct Drift {
  double value = std::numeric_limits<double>::quiet_NaN();
  double ci99 = std::numeric_limits<double>::quiet_NaN();
};

/// The paper, Sec. II: one turn to reach steady flow, the energy checked over the next, all snapshots within
/// it.
struct Steadiness {
  bool steady = true;
  std::vector<std::string> reasons;                         ///< why not, as sentences; empty when steady
  double turns = std::numeric_limits<double>::quiet_NaN();  ///< measured; NaN without a turning wall
  double turns_before = std::numeric_limits<double>::quiet_NaN();  ///< of the wall before that
  Drift energy;     ///< of the kinetic energy relative to the drum, over its mean
  Drift slope_deg;  ///< of the angle of the centre of mass
  double energy_std = std::numeric_limits<double>::quiet_NaN();     ///< standard deviation over the mean
  double slope_std_deg = std::numeric_limits<double>::quiet_NaN();  ///< of the angle of the centre of mass
};

/// `rotation`: spin of the wall; `batches` of the intervals, half of them in each half of the series.
Steadiness steadiness(const TimeSeries& series, double rotation, std::size_t batches);

}  // namespace drumlin::particles
