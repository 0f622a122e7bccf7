#include "coupling/core/law/knot_influence.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace drumlin {
namespace {

// Derivatives of Steffen's slope by the chords on its left and right.
std::array<double, 2> by_chords(double left, double right, double h_left, double h_right) {
  if (left * right <= 0) return {0, 0};
  const double of_left = h_right / (h_left + h_right), of_right = h_left / (h_left + h_right);
  const double parabola = 0.5 * std::abs(left * of_left + right * of_right);
  if (parabola <= std::min(std::abs(left), std::abs(right))) return {of_left, of_right};
  return std::abs(left) <= std::abs(right) ? std::array{2.0, 0.0} : std::array{0.0, 2.0};
}

}  // namespace

KnotInfluence::KnotInfluence(std::vector<double> x, const std::vector<double>& y,
                             MonotoneCubic::Outside outside)
    : x_(std::move(x)), slope_(x_.size(), OfSlope{}) {
  assert(!x_.empty() && x_.size() == y.size() && (outside == MonotoneCubic::Outside::level || x_.size() > 1));
  const auto h = [&](std::size_t i) { return x_[i + 1] - x_[i]; };
  const auto chord = [&](std::size_t i) { return (y[i + 1] - y[i]) / h(i); };
  for (std::size_t i = 1; i + 1 < x_.size(); ++i) {
    const auto [left, right] = by_chords(chord(i - 1), chord(i), h(i - 1), h(i));
    slope_[i] = {-left / h(i - 1), left / h(i - 1) - right / h(i), right / h(i)};
  }
  if (outside == MonotoneCubic::Outside::goes_on) {
    const std::size_t last = x_.size() - 2;
    slope_.front() = {0, -1 / h(0), 1 / h(0)};
    slope_.back() = {-1 / h(last), 1 / h(last), 0};
  }
}

void KnotInfluence::add_slope(std::size_t knot, double factor, std::span<double> by_knot) const {
  const OfSlope& slope = slope_[knot];
  if (knot > 0) by_knot[knot - 1] += factor * slope[0];
  by_knot[knot] += factor * slope[1];
  if (knot + 1 < x_.size()) by_knot[knot + 1] += factor * slope[2];
}

void KnotInfluence::at(double at, std::span<double> by_knot) const {
  assert(by_knot.size() == x_.size());
  std::fill(by_knot.begin(), by_knot.end(), 0.0);
  if (at <= x_.front() || at >= x_.back()) {
    const std::size_t end = at <= x_.front() ? 0 : x_.size() - 1;
    by_knot[end] = 1;
    return add_slope(end, at - x_[end], by_knot);
  }
  const auto i = static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), at) - x_.begin()) - 1;
  const double h = x_[i + 1] - x_[i], t = (at - x_[i]) / h;
  // Hermite's form.
  by_knot[i] = (1 + 2 * t) * (1 - t) * (1 - t);
  by_knot[i + 1] = t * t * (3 - 2 * t);
  add_slope(i, h * t * (1 - t) * (1 - t), by_knot);
  add_slope(i + 1, h * t * t * (t - 1), by_knot);
}

}  // namespace drumlin
