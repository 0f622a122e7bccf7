#include "coupling/core/law/monotone_cubic.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace drumlin {
namespace {

// Steffen's slope at a point between chords of slopes left and right, of lengths h_left and h_right.
double inner_slope(double left, double right, double h_left, double h_right) {
  if (left * right <= 0) return 0;
  const double parabola = (left * h_right + right * h_left) / (h_left + h_right);
  const double size = 2 * std::min({std::abs(left), std::abs(right), 0.5 * std::abs(parabola)});
  return std::copysign(size, left);
}

}  // namespace

MonotoneCubic::MonotoneCubic(std::vector<double> x, std::vector<double> y, Outside outside,
                             std::optional<double> last_slope)
    : x_(std::move(x)), y_(std::move(y)), slope_(x_.size(), 0) {
  assert(!x_.empty() && x_.size() == y_.size() && (outside == Outside::level || x_.size() > 1));
  const auto h = [&](std::size_t i) { return x_[i + 1] - x_[i]; };
  const auto chord = [&](std::size_t i) { return (y_[i + 1] - y_[i]) / h(i); };
  for (std::size_t i = 1; i + 1 < x_.size(); ++i)
    slope_[i] = inner_slope(chord(i - 1), chord(i), h(i - 1), h(i));
  if (outside == Outside::goes_on) {
    slope_.front() = chord(0);
    slope_.back() = last_slope.value_or(chord(x_.size() - 2));
  }
}

CurvePoint MonotoneCubic::at(double x) const {
  if (x <= x_.front()) return {y_.front() + slope_.front() * (x - x_.front()), slope_.front()};
  if (x >= x_.back()) return {y_.back() + slope_.back() * (x - x_.back()), slope_.back()};
  const auto i = static_cast<std::size_t>(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin()) - 1;
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h, chord = (y_[i + 1] - y_[i]) / h;
  // y + t h (m0 + t (q + t c)) in Hermite's form.
  const double m0 = slope_[i], m1 = slope_[i + 1];
  const double q = 3 * chord - 2 * m0 - m1, c = m0 + m1 - 2 * chord;
  return {y_[i] + t * h * (m0 + t * (q + t * c)), m0 + t * (2 * q + 3 * t * c)};
}

std::vector<double> logarithms(std::vector<double> values) {
  for (double& value : values) value = std::log(value);
  return values;
}

}  // namespace drumlin
