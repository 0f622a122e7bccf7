#pragma once
// mu(I) = a + b ln I of the profile at the centre of one run, with the errors that the run alone can tell.
#include <span>
#include <string>
#include <vector>

#include "coupling/calibration/log_friction.hpp"
#include "coupling/core/results/profile_set.hpp"
#include "coupling/core/results/scalar_set.hpp"

namespace drumlin::coupling {

/// The law with its scalars mu_a and mu_b; NaN where fewer than three layers are selected.
struct CentreFriction {
  LogLaw law;
  ScalarSet scalars;
};

/// `leave_one_out`: the same profile without one part of the run each, in order of time; `interval_factor`:
/// half widths of 99 % intervals per jackknife error of so many parts. An interval is the root of the sum of
/// squares of the jackknife's and of the fit's: layers of one run move together (a steeper surface raises mu
/// in all), which the fit cannot know.
CentreFriction centre_friction(const ProfileSet& profiles, std::span<const ProfileSet> leave_one_out,
                               double interval_factor, const LayerSelection& selection);

/// The law of a profile without header and intervals of its own: it borrows those of the measured one, layer
/// by layer the nearest. Without them its layers would be chosen and weighted otherwise.
LogLaw friction_with_borrowed_intervals(ProfileSet profiles, const ProfileSet& measured,
                                        const LayerSelection& selection);

/// The same profile with another selection of its layers.
struct FrictionVariant {
  std::string change;  ///< in words
  LogLaw law;
};

std::vector<FrictionVariant> friction_variants(const ProfileSet& profiles, const LayerSelection& selection);

}  // namespace drumlin::coupling
