#pragma once
// Walls around which grains are generated.
#include <vector>

#include "particles/scene/region.hpp"

namespace drumlin::particles {

/// Whether grains are generated around a wall, so that it may reach into their region.
bool placed_around(const GeneratedGrains& grains, const Wall& wall);

/// Shapes that generated grains must not overlap, with the discs glued to them, as the scene begins.
class Obstacles {
 public:
  Obstacles(const GeneratedGrains& grains, const Scene& scene);
  /// Whether a disc, in mm, overlaps none of them, nor one of their images in a periodic domain.
  bool clear(const Point_mm& center, double radius) const;

 private:
  std::vector<WallShape> shapes_;
  std::vector<double> images_{0};  // shifts along x
};

}  // namespace drumlin::particles
