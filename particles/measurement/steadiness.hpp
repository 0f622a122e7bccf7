#pragma once
// Steadiness of a run: whether it had reached steady flow, and was observed for long enough to tell.
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "particles/measurement/frame/survey.hpp"

namespace drumlin::particles {

/// A change, as between the first and the second half of the snapshots, with its 99 % half width.
struct Drift {
  double value = std::numeric_limits<double>::quiet_NaN();
  double ci99 = std::numeric_limits<double>::quiet_NaN();
};

/// Change over the whole time by a straight line through the means of blocks, given in order of time, with
/// its 99 % half width: from the scatter of the blocks about the line, with the correlation of neighbours. A
/// trend of its own does not widen it, as it widens the interval of a half. NaN with fewer than four blocks.
Drift trend_over(std::span<const double> blocks);

/// A drum, the paper, Sec. II: one turn to reach steady flow, the energy checked over the next, all snapshots
/// within it. Without a drum the energy belongs to a few grains that jump, when shear is slow: where it
/// scatters too much to tell, pressure, shear stress and shear rate of the whole packing judge in its place.
struct Steadiness {
  bool steady = true;
  bool flows = true;  ///< false: a grain moves by less than least_path over all snapshots, and is not judged
  std::vector<std::string> reasons;                         ///< why not, as sentences; empty when steady
  double turns = std::numeric_limits<double>::quiet_NaN();  ///< measured; NaN without a turning wall
  double turns_before = std::numeric_limits<double>::quiet_NaN();  ///< of the wall before that
  Drift energy;     ///< of the kinetic energy relative to the drum, over its mean
  Drift slope_deg;  ///< of the angle of the centre of mass
  double energy_std = std::numeric_limits<double>::quiet_NaN();     ///< standard deviation over the mean
  double slope_std_deg = std::numeric_limits<double>::quiet_NaN();  ///< of the angle of the centre of mass
  Drift energy_trend;  ///< of the logarithm of the kinetic energy: exp(value) is the factor
  /// Without a container, over the mean of the pressure, of the shear stress or of the shear rate; NaN where
  /// that mean is not known to half its size.
  Drift pressure, shear_stress, shear_rate;
  std::string judged_by;  ///< "kinetic energy", "kinetic energy and slope", "stress and shear rate"
};

/// d: a layer that creeps or rests is no flow, however constant its energy.
inline constexpr double least_path = 0.1;

/// `rotation`: spin of the wall; `batches` of the intervals, half of them in each half of the series.
Steadiness steadiness(const TimeSeries& series, double rotation, std::size_t batches);

}  // namespace drumlin::particles
