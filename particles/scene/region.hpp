#pragma once
// Geometry of the region in which grains are placed; millimetres, as in the scene.
#include <utility>
#include <variant>

#include "particles/scene/scene.hpp"

namespace drumlin::particles {

inline constexpr double radian = std::numbers::pi / 180;  ///< a degree in rad

using Region = std::variant<CircleRegion, RectangleRegion>;
using WallShape = std::variant<ContainerShape, SegmentShape, DiscShape, PolylineShape, ArcShape>;

/// Least and greatest coordinate along an axis: 0 for x, 1 for z.
std::pair<double, double> extent_mm(const Region& region, int axis);
/// Distance of the region's farthest point from `center`.
double farthest_mm(const Region& region, const Point_mm& center);
/// Whether a disc lies inside the region; a point has the radius 0.
bool inside(const Region& region, const Point_mm& center, double radius);
/// Whether a segment, an arc or a disc reaches into the region, its border not counted: a region may lie
/// against a wall. `tolerance` is relative to the size of the region. A container crosses nothing.
bool crosses(const Region& region, const WallShape& shape, double tolerance);
/// Distance of a point from the nearest one of a shape; negative inside a disc or outside of a container.
double distance_mm(const WallShape& shape, const Point_mm& point);

}  // namespace drumlin::particles
