#pragma once
// Grains that have left a scene: they fly on and no longer take part in what it is about.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// Distance, d, beyond the box around all that a scene names at which a grain counts as gone.
inline constexpr double left_distance = 100;
/// So many are named.
inline constexpr std::size_t named_left = 10;

/// When and in which stage a grain left.
struct LeftGrain {
  std::int64_t grain = 0;  ///< its identity; where the number of grains cannot change, its index
  std::int32_t stage = 0;
  double time = 0;
};

/// All that have left so far. A grain counts once, whether it comes back or not.
struct LeftGrains {
  std::vector<std::uint8_t> has_left;   ///< of each grain
  std::vector<std::int64_t> per_stage;  ///< counts
  std::vector<LeftGrain> first;         ///< in the order in which they left
};

/// An upright rectangle.
struct Extent {
  double x_low, x_high, z_low, z_high;
  void add(double x, double z, double radius = 0);
};

/// Around the regions of grains, outlets and sources, listed grains, and all walls where they stand at first.
/// Unlimited in x in a periodic domain.
Extent extent_of(const Scene&, const Scales&, const Walls&);
/// Also around shapes.
Extent with_shapes(Extent, std::span<const Shape>);
/// Whether a grain's centre is further than left_distance outside, in x or z.
bool is_gone(const Extent&, double x, double z);

}  // namespace drumlin::particles
