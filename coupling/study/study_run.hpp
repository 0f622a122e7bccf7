#pragma once
// The measured runs that a study reads, and which of them belong together.
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin {

/// What `drumlin measure` left of one run.
struct StudyRun {
  std::string name;
  double rotation_rpm = 0;
  ProfileSet profiles;
  std::map<double, ProfileSet> slices;  ///< narrow slices by their position x, where they were measured
  ScalarSet scalars;
  /// What must be the same in all runs of a study, as text: grains, walls, effects, settings of the
  /// measurement.
  std::map<std::string, std::string> identity;
  /// What may differ between runs, but is worth a word: time steps, tolerance of the solver.
  std::map<std::string, std::string> numerics;
  std::vector<std::string> warnings;  ///< why it counts less than a steady whole turn
  double cpu_seconds = std::numeric_limits<double>::quiet_NaN();  ///< of the run; NaN where it does not say
};

/// Throws InputError, every difference at once, unless the runs show the same drum, grains and definitions;
/// also when a run is named twice, stands still, or there is none.
void require_one_study(const std::vector<StudyRun>& runs);

/// Runs at one speed of rotation (to 0.5 %), as indices into the runs of the study, with their pooled
/// scalars.
struct SpeedGroup {
  double rotation_rpm = 0;
  std::vector<std::size_t> runs;
  ScalarSet scalars;
};

/// Mean of one quantity over several runs. Half width: that of the mean of independent runs,
/// sqrt(sum ci99^2)/n, times the Birge ratio sqrt(chi^2/(n - 1)) of the runs about their mean where it
/// exceeds one, so that a spread between runs that their intervals do not explain widens it. (Student's t of
/// the spread alone would need t = 63.7 for two runs.) NaN values are left out; runs without an interval give
/// a mean without one.
Scalar pooled(const std::string& name, const std::vector<Scalar>& runs);

/// Ascending speeds. Every scalar that one of the runs has is pooled.
std::vector<SpeedGroup> speed_groups(const std::vector<StudyRun>& runs);

}  // namespace drumlin
