#include "tests/hardcases/registry.hpp"

#include "tests/hardcases/particles/case_lists.hpp"

namespace drumlin {

const std::vector<HardCase>& particle_hard_cases() {
  static const std::vector<HardCase> all =
      joined({impact_cases(), energy_cases(), sliding_cases(), static_cases(), overlap_cases(), drum_cases(),
              invariance_cases(), wall_cases(), smooth_cases()});
  return all;
}

}  // namespace drumlin
