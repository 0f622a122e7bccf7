#pragma once
// A pair of a grain and another grain or a wall that touch or may touch within the step.
#include <cstdint>
#include <span>

#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// The unit normal points from j to i; the tangent is (n_z, -n_x).
struct Candidate {
  std::int32_t i = 0;  ///< grain
  std::int32_t j = 0;  ///< grain with j > i, or -1 - s for wall shape s
  double gap = 0;      ///< distance of the surfaces, negative when they overlap
  double n_x = 0, n_z = 0;
  /// Displacement of the wall's material point over the step / step; between grains, velocity of the image of
  /// j that is nearest against j itself, 0 unless images move.
  double wall_v_x = 0, wall_v_z = 0;
};

/// The bodies of pairs, which many loops need alone: grains, and from `fixed` on walls.
struct PairBodies {
  std::span<const std::int32_t> i, j;
  std::int32_t fixed = 0;
};

/// Components of a relative velocity of i and j.
inline double normal_part(const Candidate& pair, const Point& u) { return pair.n_x * u.x + pair.n_z * u.z; }
inline double tangential_part(const Candidate& pair, const Point& u) {
  return pair.n_z * u.x - pair.n_x * u.z;
}

}  // namespace drumlin::particles
