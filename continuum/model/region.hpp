#pragma once
// A region of walls and openings, and the material that fills a part of it: what a flow with a free surface
// is given. The axes are those of the scene: gravity may point anywhere, x and z are as the walls are given.
#include <array>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "continuum/model/flow_problem.hpp"

namespace drumlin::continuum {

/// Straight; the material may lie on either side.
struct SegmentCurve {
  Vec2 from, to;
};
/// The material lies inside.
struct CircleCurve {
  Vec2 center;
  double radius = 0;
};

/// A wall, or an opening through which material leaves.
struct RegionPart {
  enum class Kind { rough, friction, opening };  ///< no slip; Coulomb (0: smooth, a plane of symmetry); p = 0
  std::string name;
  std::variant<SegmentCurve, CircleCurve> curve;
  Kind kind = Kind::rough;
  double friction = 0;  ///< of a wall with friction
  Vec2 velocity = {};   ///< of the wall, sqrt(g d); a segment moves with it
  double rotation = 0;  ///< of a circle about its centre, positive in the sense of dv_x/dz, sqrt(g/d)
  double begins = 0;    ///< time from which it moves; of an opening: from which it is open (a wall before)
  double ends = std::numeric_limits<double>::infinity();  ///< time from which it is no longer there
};

/// Units d, sqrt(d/g).
struct Region {
  std::vector<RegionPart> parts;
  std::vector<Vec2>
      fill;  ///< outline of the material at the start, anticlockwise; straight between the points
};

/// Outline of the material: closed, anticlockwise.
struct Outline {
  static constexpr int free = -1;
  std::vector<Vec2> points;
  std::vector<int> part;  ///< of the side from point i to the next: index in Region::parts, or free
};

/// Triangles that fill an outline; each is cut into three quadrilaterals (fem/), whose further vertices, the
/// middles of its sides and its centre, move with its corners.
struct RegionMesh {
  std::vector<Vec2> vertices;
  std::vector<std::array<unsigned int, 3>> triangles;  ///< anticlockwise
  struct Edge {
    unsigned int from = 0, to = 0;  ///< vertices, the material on the left
    int part = Outline::free;
  };
  std::vector<Edge> boundary;  ///< round one outline after the other in its order
};

}  // namespace drumlin::continuum
