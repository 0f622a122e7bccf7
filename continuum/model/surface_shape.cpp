#include "continuum/model/surface_shape.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "continuum/quadrature/integral.hpp"
#include "coupling/core/statistics/straight_line.hpp"

namespace drumlin::continuum {
namespace {

// What a shape asks of its domain.
struct DomainOutline {
  double z = 0;
  double half_width(const ChordDomain& d) const {
    const double above = z - d.axis_offset;
    return std::sqrt(std::max(0.0, d.radius * d.radius - above * above));
  }
  double half_width(const BoxDomain& d) const { return 0.5 * d.width; }
  template <class NoChord>  // no surface that is one polynomial
  double half_width(const NoChord&) const {
    return 0;
  }
  double half_width_slope(const ChordDomain& d) const { return -(z - d.axis_offset) / half_width(d); }
  double half_width_slope(const BoxDomain&) const { return 0; }
  template <class NoChord>
  double half_width_slope(const NoChord&) const {
    return 0;
  }
  // Integral of the half width from some height up to z.
  double half_area(const ChordDomain& d) const {
    const double above = z - d.axis_offset;
    return 0.5 *
           (above * half_width(d) + d.radius * d.radius * std::asin(std::clamp(above / d.radius, -1.0, 1.0)));
  }
  double half_area(const BoxDomain& d) const { return 0.5 * d.width * z; }
  template <class NoChord>
  double half_area(const NoChord&) const {
    return 0;
  }
  double depth(const ChordDomain& d) const { return d.radius - d.axis_offset; }
  double depth(const BoxDomain& d) const { return d.height; }
  template <class NoChord>
  double depth(const NoChord&) const {
    return 1;
  }
};

double half_width(const SurfaceShape& shape, double z) {
  return std::visit([z](const auto& d) { return DomainOutline{z}.half_width(d); }, shape.domain);
}
double half_width_slope(const SurfaceShape& shape, double z) {
  return std::visit([z](const auto& d) { return DomainOutline{z}.half_width_slope(d); }, shape.domain);
}
double half_area(const SurfaceShape& shape, double z) {
  return std::visit([z](const auto& d) { return DomainOutline{z}.half_area(d); }, shape.domain);
}

constexpr int samples = 400;  // over s; the shape has some ten bends

double sample(int i) { return 2 * (i + 0.5) / samples - 1; }

}  // namespace

double chebyshev(std::size_t n, double s) {
  return std::cos(static_cast<double>(n) * std::acos(std::clamp(s, -1.0, 1.0)));
}

// Clenshaw's recurrence.
double rise(const SurfaceShape& shape, double s) {
  double next = 0, after = 0;
  for (std::size_t n = shape.coefficient.size(); n-- > 1;) {
    const double here = shape.coefficient[n] + 2 * s * next - after;
    after = next;
    next = here;
  }
  return shape.coefficient.empty() ? 0 : shape.coefficient[0] + s * next - after;
}

// T_n' = n U_(n-1), and Clenshaw's recurrence for U.
double rise_slope(const SurfaceShape& shape, double s) {
  double next = 0, after = 0;
  for (std::size_t n = shape.coefficient.size(); n-- > 1;) {
    const double here = static_cast<double>(n) * shape.coefficient[n] + 2 * s * next - after;
    after = next;
    next = here;
  }
  return next;
}

double across(const SurfaceShape& shape, Vec2 point) {
  const double w = half_width(shape, point.z);
  return w > 0 ? std::clamp(point.x / w, -1.0, 1.0) : 0;
}

Vec2 surface_point(const SurfaceShape& shape, double s) {
  const double z = rise(shape, s);
  return {s * half_width(shape, z), z};
}

Vec2 surface_normal(const SurfaceShape& shape, double s) {
  const double z = rise(shape, s), dz = rise_slope(shape, s);
  const double dx = half_width(shape, z) + s * half_width_slope(shape, z) * dz;
  const double length = std::hypot(dx, dz);
  return {-dz / length, dx / length};
}

double height(const SurfaceShape& shape, double x) {
  if (x < surface_point(shape, -1).x || x > surface_point(shape, 1).x) return 0;
  double low = -1, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (surface_point(shape, middle).x < x ? low : high) = middle;
  }
  return rise(shape, 0.5 * (low + high));
}

double largest_height(const SurfaceShape& shape) {
  double largest = std::max(std::abs(rise(shape, -1)), std::abs(rise(shape, 1)));
  for (int i = 0; i < samples; ++i) largest = std::max(largest, std::abs(rise(shape, sample(i))));
  return largest;
}

double highest_point(const SurfaceShape& shape) {
  double highest = std::max(rise(shape, -1), rise(shape, 1));
  for (int i = 0; i < samples; ++i) highest = std::max(highest, rise(shape, sample(i)));
  return highest;
}

double mean_slope(const SurfaceShape& shape, double half_length) {
  const double range = std::min(1.0, half_length / half_width(shape, 0));
  std::vector<double> x, z;
  for (int i = 0; i < samples; ++i) {
    const Vec2 p = surface_point(shape, range * sample(i));
    x.push_back(p.x);
    z.push_back(p.z);
  }
  return -std::atan(statistics::fit_line(x, z)->slope);
}

double area_above(const SurfaceShape& shape) {
  const double below = half_area(shape, 0);
  return integral([&](double s) { return half_area(shape, rise(shape, s)) - below; }, -1, 1);
}

void restrain(SurfaceShape& shape, double half_length) {
  const double w = half_width(shape, 0);
  // The area is nearly linear in the first coefficient and the slope in the second, each nearly blind to the
  // other: the passes gain about two digits each.
  for (int pass = 0; pass < 40; ++pass) {
    const double too_high = area_above(shape) / (2 * w);
    const double too_steep = half_length > 0 ? w * std::tan(mean_slope(shape, half_length)) : 0;
    shape.coefficient[0] -= too_high;
    shape.coefficient[1] += too_steep;
    if (std::abs(too_high) + std::abs(too_steep) < 1e-14 * w) break;
  }
}

Vec2 displaced(const SurfaceShape& shape, Vec2 point) {
  const double reach = 0.8 * std::visit([](const auto& d) { return DomainOutline{}.depth(d); }, shape.domain);
  const double share = 1 + point.z / reach;
  if (share <= 0) return point;
  const double s = across(shape, point);
  const double z = point.z + rise(shape, s) * share * share;
  return {s * half_width(shape, z), z};
}

}  // namespace drumlin::continuum
