#include "particles/detection/contact_order.hpp"

#include <algorithm>

namespace drumlin::particles {

namespace {

double extent(const std::vector<double>& positions) {
  if (positions.empty()) return 0;
  double low = positions[0], high = low;
  for (const double x : positions) low = std::min(low, x), high = std::max(high, x);
  return high - low;
}

}  // namespace

void ContactOrder::sort(const std::vector<Candidate>& pairs, const Bodies& bodies, const Period& period,
                        SweepPlan& plan, std::vector<Candidate>& sorted) {
  i_.resize(pairs.size());
  j_.resize(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) i_[p] = pairs[p].i, j_[p] = pairs[p].j;
  const bool along_x = period.open() && extent(bodies.x) > extent(bodies.z);
  planner_.plan(body_slices_along(along_x ? bodies.x : bodies.z, i_, j_), i_, j_, plan, order_);
  sorted.resize(pairs.size());
  loops_.each(pairs.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) sorted[p] = pairs[order_[p]];
  });
}

}  // namespace drumlin::particles
