#pragma once
// How well a law describes a run that it was fitted on or not.
#include <cstddef>
#include <string>
#include <vector>

#include "coupling/calibration/calibrated_law.hpp"

namespace drumlin::coupling {

/// The law against points, those within its range of I.
struct LawScore {
  std::string run;
  std::size_t points = 0;         ///< within the range
  std::size_t outside_range = 0;  ///< points beyond it: not predicted
  double rms = 0;                 ///< of mu - law
  double bias = 0;                ///< mean of it
  /// Share of the points inside the 99 % interval that errors, scatter and band give.
  double inside_prediction = 0;
  double largest = 0;  ///< largest |mu - law|, and where
  double largest_at_I = 0;
};
LawScore score_of(const std::string& run, const std::vector<FrictionPoint>& points, const CalibratedLaw& law);

}  // namespace drumlin::coupling
