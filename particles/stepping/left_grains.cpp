#include "particles/stepping/left_grains.hpp"

#include <algorithm>
#include <limits>

#include "particles/bodies/arc.hpp"
#include "particles/scene/placement.hpp"
#include "particles/scene/region.hpp"

namespace drumlin::particles {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

void add(const Region& region, double unit, Extent& extent) {
  const auto [left, right] = extent_mm(region, 0);
  const auto [bottom, top] = extent_mm(region, 1);
  extent.add(left * unit, bottom * unit);
  extent.add(right * unit, top * unit);
}

void add(const Shape& shape, Extent& extent) {
  if (const auto r = reaches_of(shape)) {
    extent.add(r->x_low, r->z_low);
    extent.add(r->x_high, r->z_high);
  }
  if (const auto* c = std::get_if<Container>(&shape)) extent.add(c->center.x, c->center.z, c->radius);
}

}  // namespace

void Extent::add(double x, double z, double radius) {
  x_low = std::min(x_low, x - radius), x_high = std::max(x_high, x + radius);
  z_low = std::min(z_low, z - radius), z_high = std::max(z_high, z + radius);
}

Extent extent_of(const Scene& scene, const Scales& scales, const Walls& walls) {
  Extent extent{infinite, -infinite, infinite, -infinite};
  const double unit = 1e-3 / scales.length_m;
  if (const auto* made = std::get_if<GeneratedGrains>(&scene.grains.source)) add(made->region, unit, extent);
  for (const GrainGroup& group : scene.grains.groups)
    if (const auto* made = std::get_if<GeneratedGrains>(&group.source)) add(made->region, unit, extent);
  for (const Point_mm& place : listed_places_mm(scene.grains)) extent.add(place[0] * unit, place[1] * unit);
  for (const Outlet& outlet : scene.outlets) {
    add(outlet.region, unit, extent);
    if (outlet.returns_to) add(*outlet.returns_to, unit, extent);
  }
  for (const Source& source : scene.sources) add(source.region, unit, extent);
  extent = with_shapes(extent, walls.reference);
  if (scene.periodic_x) extent.x_low = -infinite, extent.x_high = infinite;
  if (scene.periodic_z) extent.z_low = -infinite, extent.z_high = infinite;
  return extent;
}

Extent with_shapes(Extent extent, std::span<const Shape> shapes) {
  for (const Shape& shape : shapes) add(shape, extent);
  return extent;
}

bool is_gone(const Extent& extent, double x, double z) {
  return x < extent.x_low - left_distance || x > extent.x_high + left_distance ||
         z < extent.z_low - left_distance || z > extent.z_high + left_distance;
}

}  // namespace drumlin::particles
