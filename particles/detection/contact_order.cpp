#include "particles/detection/contact_order.hpp"

namespace drumlin {

void ContactOrder::sort(std::vector<Candidate>& pairs, std::size_t bodies,
                        std::vector<std::int32_t>& strip_of_body, SweepPlan& plan) {
  i_.resize(pairs.size());
  j_.resize(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) i_[p] = pairs[p].i, j_[p] = pairs[p].j;
  if (strip_of_body.size() != bodies || !planner_.plan(strip_of_body, i_, j_, plan, order_)) {
    strip_of_body = body_strips(static_cast<std::int32_t>(bodies), i_, j_);
    planner_.plan(strip_of_body, i_, j_, plan, order_);
  }
  sorted_.resize(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) sorted_[p] = pairs[order_[p]];
  pairs.swap(sorted_);
}

}  // namespace drumlin
