#pragma once
// Whether the curves of several speeds over I are one curve.
#include <string>
#include <vector>

#include "coupling/study/study_run.hpp"

namespace drumlin::coupling {

/// One quantity over the inertial number in one run, I ascending; half widths of 99 % intervals, that of I
/// counted through the slope of the curve.
struct InertialCurve {
  std::vector<double> I, value, ci99;
};

/// Layers below z = -2 and more than 3 d from the wall, from the surface down as long as the shear rate
/// exceeds its own interval; layers where I does not fall below all layers above them are left out.
InertialCurve inertial_curve(const ProfileSet& profiles, const std::string& column);

/// Speeds compared at one inertial number.
struct CollapsePoint {
  double I = 0;
  double mean = 0;    ///< of the speeds, weighted by their intervals
  double spread = 0;  ///< standard deviation between the speeds
  double chi2 = 0;    ///< sum over speeds of ((value - mean) / s)^2, s = ci99 / 2.576
  std::size_t speeds = 0;
};

/// `ratio` = sqrt(sum chi2 / sum (speeds - 1)) over the points: 1 where the intervals explain the spread
/// between the speeds. The curves are one (`collapse`) when it stays below `limit`, the 99 % quantile of
/// sqrt(chi^2/(n - 1)) for n speeds: as if all layers of a run moved together, so that more points make no
/// stricter test.
struct Collapse {
  std::string column;
  std::vector<CollapsePoint> points;
  double ratio = 0;
  double limit = 0;
  double spread = 0;  ///< rms over the points
  double range = 0;   ///< greatest - smallest mean over the points
  bool collapse = false;
};

/// Four inertial numbers per decade from I_min to I_max, those that at least two speeds reach; runs of a
/// speed are pooled first. NaN and no collapse where there is none.
Collapse collapse_of(const std::string& column, const std::vector<StudyRun>& runs,
                     const std::vector<SpeedGroup>& groups, double I_min = 1e-4, double I_max = 1e-1);

}  // namespace drumlin::coupling
