#pragma once
// How well a law describes runs that it was fitted on or not, and whether one law describes all of them.
#include <cstddef>
#include <string>
#include <vector>

#include "coupling/calibration/robust_law.hpp"

namespace drumlin {

/// A fitted law with the laws of other draws of its points.
struct CalibratedLaw {
  FrictionForm form;
  RobustFriction fit;
  std::vector<Coefficients> draws;
  double I_min = 0, I_max = 0;  ///< of its points: where it is valid
};

/// A table is kept well-posed (kept_well_posed()). Throws InputError as fit_friction().
CalibratedLaw calibrated(const std::vector<std::vector<FrictionPoint>>& runs, const FrictionForm& form,
                         int draws);

/// The law against points, those within its range of I.
struct LawScore {
  std::string run;
  std::size_t points = 0;   ///< within the range
  std::size_t outside = 0;  ///< points beyond it: not predicted
  double rms = 0;           ///< of mu - law
  double bias = 0;          ///< mean of it
  double inside_prediction =
      0;               ///< share of the points inside the 99 % interval that errors, scatter and band give
  double largest = 0;  ///< largest |mu - law|, and where
  double largest_at_I = 0;
};
LawScore score_of(const std::string& run, const std::vector<FrictionPoint>& points, const CalibratedLaw& law);

/// One law for all speeds against a law for each.
struct OneLaw {
  double rms_common = 0;  ///< of mu about the common law
  double rms_own = 0;     ///< about each speed's own law
  double largest_ratio =
      0;  ///< |own - common| over the root of the sum of the squares of their 99 % half widths
  double difference = 0;  ///< own - common there
  double at_I = 0;
  std::string speed;
  bool holds = false;  ///< largest_ratio <= 1
};
struct RunsOfSpeed {
  std::string name;
  std::vector<std::vector<FrictionPoint>> runs;
};
/// Compared at 25 inertial numbers of the range that a speed and the common law share. Needs two speeds.
OneLaw one_law_of(const std::vector<RunsOfSpeed>& speeds, const CalibratedLaw& common, int draws);

/// Half width of the 99 % band at I, the mean of its two sides.
double half_width_at(const CalibratedLaw& law, double I);

}  // namespace drumlin
