#pragma once
// Whether one law describes runs of several speeds.
#include <string>
#include <vector>

#include "coupling/calibration/calibrated_law.hpp"

namespace drumlin::coupling {

/// One law for all speeds against a law for each.
struct OneLaw {
  double rms_common = 0;  ///< of mu about the common law
  double rms_own = 0;     ///< about each speed's own law
  /// |own - common| over the root of the sum of the squares of their 99 % half widths.
  double largest_ratio = 0;
  double difference = 0;  ///< own - common there
  double at_I = 0;
  std::string speed;
  bool holds = false;  ///< largest_ratio <= 1
};
struct RunsOfSpeed {
  std::string name;
  std::vector<std::vector<FrictionPoint>> runs;
};
/// Compared at 25 inertial numbers of the range that a speed and the common law share. Throws InputError with
/// fewer than two speeds.
OneLaw one_law_of(const std::vector<RunsOfSpeed>& speeds, const CalibratedLaw& common, int draws);

}  // namespace drumlin::coupling
