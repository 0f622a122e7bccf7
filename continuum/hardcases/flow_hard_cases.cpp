#include "continuum/hardcases/flow_hard_cases.hpp"

#include <iterator>
#include <utility>

#include "continuum/hardcases/case_lists.hpp"

namespace drumlin {

const std::vector<HardCase>& flow_hard_cases() {
  static const std::vector<HardCase> all = [] {
    std::vector<HardCase> cases;
    for (auto list : {limit_flow_cases(), law_flow_cases(), drum_flow_cases()})
      std::move(list.begin(), list.end(), std::back_inserter(cases));
    return cases;
  }();
  return all;
}

}  // namespace drumlin
