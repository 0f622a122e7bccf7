#include "continuum/model/outline.hpp"

#include <algorithm>
#include <numeric>

#include "continuum/model/plane_vector.hpp"

namespace drumlin::continuum {
namespace {

// Whether the line through a and b has p and q on different sides, or one of them on it.
bool parts_points(Vec2 a, Vec2 b, Vec2 p, Vec2 q) {
  const double first = cross(b - a, p - a), second = cross(b - a, q - a);
  return (first <= 0 && second >= 0) || (first >= 0 && second <= 0);
}

bool overlap(double a, double b, double c, double d) {
  return std::max(std::min(a, b), std::min(c, d)) <= std::min(std::max(a, b), std::max(c, d));
}

bool sides_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  return overlap(a.x, b.x, c.x, d.x) && overlap(a.z, b.z, c.z, d.z) && parts_points(a, b, c, d) &&
         parts_points(c, d, a, b);
}

}  // namespace

double area(const Outline& outline) {
  double sum = 0;
  const auto& p = outline.points;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) sum += 0.5 * cross(p[i] - p[0], p[i + 1] - p[0]);
  return sum;
}

std::optional<Vec2> crosses_itself(const Outline& outline) {
  const auto& p = outline.points;
  const std::size_t n = p.size();
  const auto at = [&](std::size_t i) { return p[i % n]; };
  std::vector<std::size_t> by_x(n);
  std::iota(by_x.begin(), by_x.end(), 0);
  const auto least = [&](std::size_t i) { return std::min(at(i).x, at(i + 1).x); };
  std::ranges::stable_sort(by_x, {}, least);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = by_x[k];
    const Vec2 side = at(i + 1) - at(i), next = at(i + 2) - at(i + 1);
    if (!(dot(side, side) > 0) || (cross(side, next) == 0 && dot(side, next) < 0)) return at(i + 1);
    for (std::size_t l = k + 1; l < n && least(by_x[l]) <= std::max(at(i).x, at(i + 1).x); ++l) {
      const std::size_t j = by_x[l];
      if ((i + 1) % n != j && (j + 1) % n != i && sides_meet(at(i), at(i + 1), at(j), at(j + 1)))
        return at(j);
    }
  }
  return {};
}

}  // namespace drumlin::continuum
