#pragma once
// The triangles of a region as quadrilaterals, three for each. Private to fem/.
#include <map>
#include <span>
#include <utility>

#include "continuum/fem/detail/discretisation.hpp"
#include "continuum/model/region.hpp"

namespace drumlin::continuum::fem {

struct SplitTriangles {
  using Pair = std::pair<unsigned int, unsigned int>;
  explicit SplitTriangles(const RegionMesh& mesh);

  /// Where the vertices of the quadrilaterals are, given the corners of the triangles.
  std::vector<Vec2> places(std::span<const Vec2> corners) const;
  /// Of the region, on which a side of a quadrilateral lies.
  int part_of(Pair ends) const { return parts_.at(std::minmax(ends.first, ends.second)); }

  /// Per vertex the corners whose mean it is: one, two (the first of them twice), or three.
  std::vector<std::array<unsigned int, 3>> parents;
  std::vector<std::array<unsigned int, 4>> cells;  ///< anticlockwise, a corner first

 private:
  std::map<Pair, int> parts_;
};

}  // namespace drumlin::continuum::fem
