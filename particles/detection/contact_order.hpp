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
  /// Sorts `pairs` and receives the plan: slices along the longer side of the packing (along z in a periodic
  /// domain).
  void sort(std::vector<Candidate>& pairs, const Bodies& bodies, const Period& period, SweepPlan& plan);

 private:
  SweepPlanner planner_;
  std::vector<std::int32_t> i_, j_, order_;
  std::vector<Candidate> sorted_;
};

}  // namespace drumlin::particles
