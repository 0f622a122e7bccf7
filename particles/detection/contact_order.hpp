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
  /// Lets a team share the work; the order does not depend on it.
  void use(ThreadTeam* team) {
    loops_ = TeamLoops(team);
    planner_.use(team);
  }
  /// Sorts `pairs` into `sorted` and receives the plan: slices along the longer side of the packing (along z
  /// in a periodic domain).
  void sort(const std::vector<Candidate>& pairs, const Bodies& bodies, const Period& period, SweepPlan& plan,
            std::vector<Candidate>& sorted);
  /// The same pairs in the order of the last time.
  void sort_again(const std::vector<Candidate>& pairs, std::vector<Candidate>& sorted) const;

 private:
  TeamLoops loops_;
  SweepPlanner planner_;
  std::vector<std::int32_t> i_, j_, order_;
};

}  // namespace drumlin::particles
