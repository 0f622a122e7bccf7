#pragma once
// The scalars by other windows than those of their definitions: how much hangs on the choice.
#include <string>

#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin {

/// All scalars with one window changed. Values alone: the snapshots are the same, so that their scatter
/// cancels in the difference to the standard definition.
struct ScalarVariant {
  std::string change;   ///< in words, "slice 10 d wide"
  ScalarSet scalars;    ///< only those that the change can reach
  ProfileSet profiles;  ///< by this window; without intervals
};

}  // namespace drumlin
