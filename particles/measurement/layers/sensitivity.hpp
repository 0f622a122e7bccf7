#pragma once
// Sensitivity of the scalars to the windows of their definitions.
#include <string>
#include <vector>

#include "coupling/core/results/profile_set.hpp"
#include "coupling/core/results/scalar_set.hpp"

namespace drumlin::particles {

/// All scalars with one window changed. Values alone: the snapshots are the same, so that their scatter
/// cancels in the difference to the standard definition.
struct ScalarVariant {
  std::string change;   ///< in words, "slice 10 d wide"
  ScalarSet scalars;    ///< only those that the change can reach
  ProfileSet profiles;  ///< by this window; without intervals
};

/// How far a scalar moves under other windows than its own.
struct ScalarSensitivity {
  struct Change {
    std::string change;
    double value = 0;
  };
  std::vector<Change> changes;  ///< those that move it
  double lowest = 0, highest = 0;
  std::string strongest;  ///< the change that moves it most
};
/// Empty `changes` when nothing moves it or no variants were computed.
ScalarSensitivity sensitivity_of(const Scalar& scalar, const std::vector<ScalarVariant>& variants);

}  // namespace drumlin::particles
