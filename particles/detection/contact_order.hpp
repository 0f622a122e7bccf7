#pragma once
// The order in which the contacts of a step are solved.
#include <cstdint>
#include <vector>

#include "particles/contact/sweep_plan.hpp"
#include "particles/detection/contact_list.hpp"

namespace drumlin {

/// Puts contacts into solve order and keeps the strips of bodies for as many steps as they suit.
class ContactOrder {
 public:
  /// Sorts `pairs` as `plan` says. `strip_of_body` is part of the state of a run: the strips of the last
  /// step; found anew when they do not suit (or are of another number of bodies).
  void sort(std::vector<Candidate>& pairs, std::size_t bodies, std::vector<std::int32_t>& strip_of_body,
            SweepPlan& plan);

 private:
  SweepPlanner planner_;
  std::vector<std::int32_t> i_, j_, order_;
  std::vector<Candidate> sorted_;
};

}  // namespace drumlin
