#include "particles/hardcases/hard_case.hpp"

#include <iterator>
#include <utility>

#include "particles/hardcases/case_lists.hpp"

namespace drumlin {

const std::vector<HardCase>& hard_cases() {
  static const std::vector<HardCase> all = [] {
    std::vector<HardCase> cases;
    for (auto list : {impact_cases(), energy_cases(), sliding_cases(), static_cases(), overlap_cases(),
                      drum_cases(), invariance_cases()})
      std::move(list.begin(), list.end(), std::back_inserter(cases));
    return cases;
  }();
  return all;
}

}  // namespace drumlin
