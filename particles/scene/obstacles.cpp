#include "particles/scene/obstacles.hpp"

#include <algorithm>

#include "particles/scene/scene_walls.hpp"

namespace drumlin::particles {

constexpr double touching = 1e-9;  // of a radius: a disc may touch

bool placed_around(const GeneratedGrains& grains, const Wall& wall) {
  return grains.around &&
         std::find(grains.around->begin(), grains.around->end(), wall.name) != grains.around->end();
}

Obstacles::Obstacles(const GeneratedGrains& grains, const Scene& scene) {
  for (const Wall& wall : scene.walls) {
    if (!placed_around(grains, wall)) continue;
    shapes_.push_back(wall.shape);
    for (const Point_mm& center : glued_centers_mm(wall))
      shapes_.push_back(DiscShape{center, wall.rough->diameter_mm});
  }
  if (!scene.periodic_x) return;
  const double period = scene.periodic_x->x_max_mm - scene.periodic_x->x_min_mm;
  images_ = {0, period, -period};
}

bool Obstacles::clear(const Point_mm& center, double radius) const {
  return std::none_of(shapes_.begin(), shapes_.end(), [&](const WallShape& shape) {
    return std::any_of(images_.begin(), images_.end(), [&](double shift) {
      return distance_mm(shape, {center[0] + shift, center[1]}) < radius * (1 - touching);
    });
  });
}

}  // namespace drumlin::particles
