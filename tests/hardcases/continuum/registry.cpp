#include "tests/hardcases/registry.hpp"

#include "tests/hardcases/continuum/case_lists.hpp"

namespace drumlin {

const std::vector<HardCase>& flow_hard_cases() {
  static const std::vector<HardCase> all = joined({limit_flow_cases(), law_flow_cases(), drum_flow_cases()});
  return all;
}

}  // namespace drumlin
