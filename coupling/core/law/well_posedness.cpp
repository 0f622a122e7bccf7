#include "coupling/core/law/well_posedness.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin {

double well_posedness_margin(const Strength& F, double rate, double saturation) {
  const double m = saturation;
  if (m * std::abs(F.d_pressure) >= 1) return -1;  // pressure cannot balance the wave: no symbol at all
  const double r = rate * F.d_rate / F.value;
  const auto numerator = [&](double a) { return (1 - r) * a * a - F.d_pressure * a + 1 - (1 - r) * m * m; };
  double smallest = std::min(numerator(-m), numerator(m));
  if (r < 1) smallest = std::min(smallest, numerator(std::clamp(F.d_pressure / (2 * (1 - r)), -m, m)));
  return smallest;
}

double minimum_on_circle(const CircleForm& form) {
  // Axes of Q, the smaller eigenvalue first.
  const double mean = 0.5 * (form.xx + form.yy), half = 0.5 * (form.xx - form.yy);
  const double radius = std::hypot(half, form.xy);
  const double small = mean - radius, large = mean + radius;
  const double angle = 0.5 * std::atan2(form.xy, half);  // of the larger one's axis
  const double c = std::cos(angle), s = std::sin(angle);
  const double q_large = c * form.x + s * form.y, q_small = c * form.y - s * form.x;
  // The dual of a quadratic on a circle has no gap: the minimum is the maximum over mu <= small of
  //   mu - (q_small^2/(small - mu) + q_large^2/(large - mu))/4,
  // a concave function; every value of it is a bound from below.
  const auto share = [](double q, double distance) { return q == 0 ? 0 : q / (2 * distance); };
  const auto rises = [&](double gap) {
    return std::hypot(share(q_small, gap), share(q_large, gap + large - small)) < 1;
  };
  double low = 0, high = 0.5 * std::hypot(q_small, q_large);  // gap = small - mu
  for (int i = 0; i < 100 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (rises(middle) ? high : low) = middle;
  }
  const double gap = high;
  const auto part = [&](double q, double distance) { return q == 0 ? 0 : 0.25 * q * q / distance; };
  return form.constant + small - gap - part(q_small, gap) - part(q_large, gap + large - small);
}

double well_posedness_margin(const TurnedStrength& F, double rate, double saturation,
                             const TurnFollowsSpin& spin) {
  const Strength &A = F.along, &B = F.across;
  const double m = saturation;
  if (m * std::hypot(A.d_pressure, B.d_pressure) >= 1) return -1;
  const double b = B.value / A.value, R_A = 1 - rate * A.d_rate / A.value;
  const double R_B = b - rate * B.d_rate / A.value;
  CircleForm form;
  form.constant = 1;
  form.x = -m * (A.d_pressure + b * B.d_pressure);
  form.y = m * (B.d_pressure - b * A.d_pressure + m * m * (R_B * A.d_pressure - R_A * B.d_pressure));
  form.yy = -m * m * R_A;
  form.xy = -0.5 * m * m * R_B;
  const double t = m * spin.slope / A.value, w = m * spin.spin_ratio;
  form.constant += t * m * A.d_pressure;
  form.x -= t;
  form.y += t * w * m * A.d_pressure;
  form.xy -= 0.5 * t * w;
  return minimum_on_circle(form);
}

}  // namespace drumlin
