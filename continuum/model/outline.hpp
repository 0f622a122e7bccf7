#pragma once
// The outline of the material as a polygon: its area, and whether it is one.
#include <functional>
#include <optional>

#include "continuum/model/region.hpp"

namespace drumlin::continuum {

/// Positive: anticlockwise.
double area(const Outline& outline);

/// A place at which two sides meet that are not neighbours, or a side has no length or turns back on the
/// one before.
std::optional<Vec2> crosses_itself(const Outline& outline);

// STUB
Outline outline_of(const Region& region, double time);
Outline resampled(const Outline& outline, const std::function<double(Vec2)>& size);
Outline with_area(const Outline& outline, double target);
Outline laid_down(const Outline& outline, const Region& region, double time, const std::function<double(Vec2)>& size);

}  // namespace drumlin::continuum
