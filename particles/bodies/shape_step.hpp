#pragma once
// What a shape of a wall does within a step.
#include <cstdint>
#include <span>

#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// The displacement of a shape over a step, the displacement of its surface, and the grains that it meets.
struct ShapeStep : Pose {
  ShapeStep() = default;
  ShapeStep(const Pose& displacement) : Pose(displacement) {}
  ShapeStep& operator=(const Pose&) = delete;  // it would look like the whole: set_displacement
  void set_displacement(const Pose& displacement) { static_cast<Pose&>(*this) = displacement; }

  bool meets(std::int32_t grain) const { return !materials || materials->test(material_of_grain[grain]); }

  double surface = 0;                      ///< displacement of the surface along the shape (Running)
  const MaterialSet* materials = nullptr;  ///< of the grains that it meets; none: it meets all
  std::span<const std::uint8_t> material_of_grain;
};

/// Where the material that a contact with this normal touches at a point is after the step. A surface runs
/// across the normal, round the ends of a segment too: it pushes nothing away.
Point moved(const ShapeStep&, const Shape&, Point touched, Point normal);

}  // namespace drumlin::particles
