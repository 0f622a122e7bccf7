#pragma once
// The order in which the contacts of a step are solved.
#include <cstdint>
#include <vector>

#include "particles/contact/sweep_plan.hpp"
#include "particles/detection/contact_list.hpp"

namespace drumlin::particles {

/// Puts contacts into solve order; keeps work space only.
class ContactOrder {
 public:
  /// Sorts `pairs` into `sorted` and receives the plan: slices along the longer side of the packing (along z
  /// in a periodic domain).
  void sort(const std::vector<Candidate>& pairs, const Bodies& bodies, const Period& period, SweepPlan& plan,
            std::vector<Candidate>& sorted);

 private:
  SweepPlanner planner_;
  std::vector<std::int32_t> i_, j_, order_;
};

}  // namespace drumlin::particles
