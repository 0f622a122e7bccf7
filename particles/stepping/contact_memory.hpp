#pragma once
// What a contact remembers from one step to the next.
#include <cstdint>
#include <vector>

namespace drumlin {

/// Contacts of the last step, in the order in which they were solved.
struct ContactMemory {
  std::vector<std::int32_t> i, j;
  std::vector<double> impulse;  ///< dim per contact, normal first: the warm start
  /// Approach speed (negative) of contacts that were slowed to just touching, for the restitution of the next
  /// step; 0 otherwise. Empty in a scene without restitution.
  std::vector<double> approach;
  double time_step = 0;             ///< the impulses belong to: they scale with it
};

}  // namespace drumlin
