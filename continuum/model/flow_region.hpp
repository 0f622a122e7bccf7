#pragma once
// The region of a flow scene: walls, openings, the material at the start, and what goes with a surface that
// is free to move (docs/formats/flow.md).
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/document.hpp"

namespace drumlin::continuum {

using FlowPoint_mm = std::array<double, 2>;  ///< x to the right, z upwards

/// The material lies on either side; a wall that moves goes along.
struct FlowSegment {
  FlowPoint_mm from_mm{0, 0}, to_mm{0, 0};
  std::array<double, 2> velocity_mm_s{0, 0};
};
/// The material lies inside.
struct FlowCircle {
  FlowPoint_mm center_mm{0, 0};
  double radius_mm = 0;
  double rotation_rpm = 0;  ///< positive in the sense of dv_x/dz
};
/// No slip. Takes no key.
struct FlowRoughWall {};
/// Coulomb.
struct FlowFrictionWall {
  double friction = 0;
};
/// Nothing holds what slides along it: a plane of symmetry, too. Takes no key.
struct FlowSmoothWall {};

struct FlowWall {
  std::string name;
  std::variant<FlowSegment, FlowCircle> shape;
  std::variant<FlowRoughWall, FlowFrictionWall, FlowSmoothWall> condition;
  double begins_s = 0;           ///< moves from then on
  std::optional<double> ends_s;  ///< gone from then on
};
/// Material leaves through it, nothing presses.
struct FlowOpening {
  std::string name;
  FlowPoint_mm from_mm{0, 0}, to_mm{0, 0};
  double begins_s = 0;  ///< a rough wall before
};
struct RegionMeshKeys {
  double cell = 3;       ///< d
  double slot_cell = 1;  ///< d, at openings
};
/// Frames at times that are listed, or evenly spread.
struct RegionTime {
  double end_s = 0;
  double step_s = 0;  ///< largest
  std::optional<std::vector<double>> frames_s;
  std::optional<double> frames_every_s;  ///< exactly one of the two
};
/// Grid of the frames.
struct RegionOutput {
  double map_spacing = 1;                           ///< d
  std::optional<std::array<double, 2>> x_mm, z_mm;  ///< from, to; absent: as far as walls and fill reach
  bool figures = true;
};
struct FlowRegion {
  std::vector<FlowPoint_mm> fill_mm;  ///< outline, anticlockwise
  std::vector<FlowWall> walls;
  std::vector<FlowOpening> openings;
  RegionMeshKeys mesh;
  RegionTime time;
  RegionOutput output;
};

/// Times of the frames, ascending, the end if it is one of them.
std::vector<double> frames_s(const RegionTime& time);

/// Appends what does not fit together: a fill that is no simple anticlockwise polygon, openings that a wall
/// covers or none holds, times beyond the end, and so on.
void check_region(const Document& document, const FlowRegion& region, std::vector<InputProblem>& problems);

}  // namespace drumlin::continuum
