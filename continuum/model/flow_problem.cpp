#include "continuum/model/flow_problem.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <numbers>

namespace drumlin::continuum {

double segment_area(double radius, double axis_offset) {
  const double c = axis_offset / radius;
  return radius * radius * (std::acos(c) - c * std::sqrt(1 - c * c));
}

double chord_offset(double radius, double area) {
  [[maybe_unused]] const double whole = std::numbers::pi * radius * radius;
  assert(area > 0 && area < whole);
  double low = -radius, high = radius;  // the area falls with the offset: bisection down to rounding
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (segment_area(radius, middle) > area ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Vec2 rigid_rotation(double rotation, double axis_offset, Vec2 point) {
  return {rotation * (point.z - axis_offset), -rotation * point.x};
}

std::optional<std::string> no_steady_state(const FlowProblem& problem, double I_limit) {
  if (std::holds_alternative<NewtonianLaw>(problem.law)) return std::nullopt;
  if (!problem.load) return std::nullopt;
  const auto [shear, p] = *problem.load;
  const double mu_limit = strength(problem.law, 0.5 * I_limit * std::sqrt(p), p).value / p;
  const double mu_needed = shear / p,
               slope = std::get<FixedSlope>(problem.slope).theta * 180 / std::numbers::pi;
  if (mu_needed <= mu_limit) return std::nullopt;
  const std::string who =
      slope < 90 ? fmt::format("a slope of {:.2f} deg", slope) : std::string("the weight between the walls");
  return fmt::format(
      "no local steady state: {} needs mu = {:.4f}, the law gives {:.4f} at I = {:g} and less below", who,
      mu_needed, mu_limit, I_limit);
}

}  // namespace drumlin::continuum
