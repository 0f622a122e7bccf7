#include "continuum/model/mesh_limit.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin::continuum {
namespace {

constexpr double least_order = 0.9, largest_order = 4.5, order_spread = 0.5, rounding = 1e-9;

// NaN where there is none.
double order_of(std::span<const double> last_three) {
  const double change = last_three[2] - last_three[1], before = last_three[1] - last_three[0];
  if (!(std::abs(change) > rounding * std::abs(last_three[2]))) return NAN;
  return before / change > 0 ? std::log2(before / change) : NAN;
}

}  // namespace

std::optional<MeshLimit> mesh_limit(std::span<const double> values) {
  if (values.size() < 3) return {};
  const auto last = values.last(3);
  const double order = order_of(last);
  if (!(order >= least_order && order <= largest_order)) return {};
  if (values.size() > 3) {
    const double before = order_of(values.subspan(values.size() - 4, 3));
    if (!(std::abs(order - before) <= order_spread)) return {};
  }
  return MeshLimit{order, last[2] + (last[2] - last[1]) / (std::exp2(order) - 1)};
}

}  // namespace drumlin::continuum
