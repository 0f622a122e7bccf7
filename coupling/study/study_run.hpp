#pragma once
// The measured runs that a study reads, and which of them belong together.
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin::coupling {

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
  std::vector<std::string> accepted = {};  ///< edits by hand (accepted_edits of coupling/common)
};

/// Throws InputError, every difference at once, unless the runs show the same drum, grains and definitions;
/// also when a run is named twice, stands still, or there is none.
void require_one_study(const std::vector<StudyRun>& runs);

/// Whether two speeds of rotation count as one: to 0.5 %.
bool same_speed(double a, double b);

/// Runs at one speed of rotation (same_speed), as indices into the runs of the study, with their pooled
/// scalars.
struct SpeedGroup {
  double rotation_rpm = 0;
  std::vector<std::size_t> runs;
  ScalarSet scalars;
};

/// Mean of one quantity over several runs. Half width: that of the mean of independent runs,
/// sqrt(sum ci99^2)/n, or, where that is larger, Student's t with n - 1 degrees of freedom times the standard
/// error by which the runs lie about their mean (statistics::quantile_99_of_told_errors): a spread between
/// runs that their intervals do not explain widens it, by a factor of 25 for two runs that differ as much as
/// they say. One run keeps its interval, which holds nothing of a spread between runs. NaN values are left
/// out; runs without an interval give a mean without one.
Scalar pooled(const std::string& name, const std::vector<Scalar>& runs);

/// The same at several speeds, each about its own mean: the ratio of the spread to what the intervals say is
/// taken to be one for all speeds of a quantity, so that their degrees of freedom add up.
std::vector<Scalar> pooled_speeds(const std::string& name, const std::vector<std::vector<Scalar>>& speeds);

/// Ascending speeds. Every scalar that one of the runs has is pooled.
std::vector<SpeedGroup> speed_groups(const std::vector<StudyRun>& runs);

}  // namespace drumlin::coupling
