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

/// Distance along z from the middle of the cell: grains at opposite borders, which touch, are at one place.
std::span<const double> ContactOrder::folded(const Bodies& bodies, const Period& period) {
  folded_.resize(bodies.count());
  const double middle = period.origin_z + period.length_z / 2;
  for (std::size_t b = 0; b < bodies.count(); ++b)
    folded_[b] = std::abs(period.first({bodies.x[b], bodies.z[b]}).z - middle);
  return folded_;
}

void ContactOrder::find(std::span<const Candidate> pairs, const Bodies& bodies, const Period& period,
                        SweepPlan& plan) {
  resize_closely(i_, pairs.size());
  resize_closely(j_, pairs.size());
  loops_.each(pairs.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) i_[p] = pairs[p].i, j_[p] = pairs[p].j;
  });
  const bool along_x = period.open() && extent(bodies.x) > extent(bodies.z);
  const std::span<const double> along =
      !period.open_z() ? folded(bodies, period) : std::span<const double>(along_x ? bodies.x : bodies.z);
  planner_.plan(body_slices_along(along, i_, j_), i_, j_, plan, order_);
}

}  // namespace drumlin::particles
