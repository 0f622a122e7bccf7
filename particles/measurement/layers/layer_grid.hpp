#pragma once
// Layers across a slice of a packing, and rings about a point: where a grain and a half branch lie in them.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "particles/measurement/frame/disc_area.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"

namespace drumlin::particles {

/// Layers across a slice, in a flow frame: layer l covers z_min + l thickness ... z_min + (l + 1) thickness.
/// Rings about the origin of the frame are layers too: the radius takes the place of z, the tangent, which
/// points clockwise, that of x, so that all sums keep their meaning and their signs.
struct LayerGrid {
  FlowFrame frame;
  double x_min = 0, x_max = 0;  ///< infinite when the slice is a whole period
  double z_min = 0;
  double thickness = 1;
  std::vector<double> area;  ///< of each layer, inside the container
  bool closed = false;       ///< of a cell that is periodic in z: above the top layer follows the lowest
  bool rings = false;
  std::size_t layers() const { return area.size(); }
  double z_max() const { return z_min + static_cast<double>(layers()) * thickness; }
  /// The layer that holds a height; layers() and more outside. Every grain of a closed cell is in one.
  std::size_t layer_at(double z) const;
  /// Whether a grain counts in a layer, and in which: layers() and more beside the slice too.
  std::size_t layer_of(double x, double z) const { return x < x_min || x > x_max ? layers() : layer_at(z); }
  /// The same layers as the cell of a snapshot has them, equal shares of its height; as they are without one.
  LayerGrid in_cell(const FlowSnapshot& snapshot) const;
  double z_of(std::size_t layer) const { return z_min + (static_cast<double>(layer) + 0.5) * thickness; }
  Rectangle rectangle(std::size_t layer) const;
};

/// Grid over z_from ... z_to with boundaries at whole multiples of the thickness. container_radius 0: no
/// container; otherwise its axis is the frame's origin and layers count with their area inside. `period` > 0:
/// the slice is the period.
LayerGrid layer_grid(const FlowFrame& frame, double position, double slice_width, double thickness,
                     double z_from, double z_to, double container_radius, double period);

/// Equal layers, as thick as asked for to rounding to a whole number of them, over a cell that is periodic in
/// x and z.
LayerGrid closed_grid(const FlowFrame& frame, double thickness, double z_from, double z_to, double period);

/// Rings out to `r_to`, in the axes of the laboratory. container_radius > 0: of a container about the same
/// centre, which cuts the last ring.
LayerGrid ring_grid(double centre_x, double centre_z, double thickness, double r_to, double container_radius);

/// Area common to a disc of `radius` and a circle of radius `circle` whose centres are `distance` apart.
double disc_area_in_circle(double distance, double radius, double circle);

/// Parts of a grain centred at the origin, within {x <= a}, of one centred at (x, z) within a rectangle, and
/// within a circle whose centre is `distance` from its own: areas of a disc, else volumes of a sphere.
template <int D>
double part_left_of(const GrainSample<D>& grain, double a) {
  return grain.is_sphere() ? grain.per_depth(sphere_volume_left_of(grain.radius, a))
                           : disc_area_left_of(grain.radius, a);
}
template <int D>
double part_in(const GrainSample<D>& grain, double x, double z, const Rectangle& rectangle) {
  const auto area = [&](double radius) { return disc_area_in(x, z, radius, rectangle); };
  return grain.is_sphere() ? grain.per_depth(sphere_volume(grain.radius, area)) : area(grain.radius);
}
template <int D>
double part_in_circle(const GrainSample<D>& grain, double distance, double circle) {
  const auto area = [&](double radius) { return disc_area_in_circle(distance, radius, circle); };
  return grain.is_sphere() ? grain.per_depth(sphere_volume(grain.radius, area)) : area(grain.radius);
}

/// The binning by layers (accumulate.hpp): exact areas, branches by their length in each layer. The place of
/// a grain is (x, height above the middle of its layer).
class LayerBinning {
 public:
  /// Both live as long as this.
  explicit LayerBinning(const LayerGrid& grid) : grid_(grid) {}

  template <int D, class Action>
  void each_part(const GrainSample<D>& grain, Action action) const;
  template <int D, class Action>
  void each_centre(GrainSample<D> grain, Action action) const {
    const std::size_t layer = grid_.layer_of(grain.at[0], grain.at[1]);
    if (layer >= grid_.layers()) return;
    grain.at[1] -= grid_.z_of(layer);
    action(layer, 1.0, grain);
  }
  template <int D, class Action>
  void each_share(const HalfBranch<D>& branch, Action action) const;

 private:
  /// Layers that a stretch of heights touches.
  struct Reach {
    double first, last;
  };
  Reach between(double first, double last) const {
    if (grid_.closed) return {first, last};
    return {std::max(0.0, first), std::min(static_cast<double>(grid_.layers()) - 1, last)};
  }
  /// Of a layer that the grid has, or in a closed one that is an image of it.
  std::size_t index_of(double layer) const {
    const auto count = static_cast<double>(grid_.layers());
    return static_cast<std::size_t>(grid_.closed ? layer - count * std::floor(layer / count) : layer);
  }

  const LayerGrid& grid_;
};

/// The binning by rings, seen from each place: out from the centre, and clockwise about it.
class RingBinning {
 public:
  explicit RingBinning(const LayerGrid& grid) : grid_(grid) {}

  template <int D, class Action>
  void each_part(const GrainSample<D>& grain, Action action) const;
  template <int D, class Action>
  void each_centre(GrainSample<D> grain, Action action) const {
    const double r = std::hypot(grain.at[0], grain.at[1]), ring = std::floor(r / grid_.thickness);
    if (!(ring < static_cast<double>(grid_.layers()))) return;
    const auto index = static_cast<std::size_t>(ring);
    grain.velocity = polar<D>(grain.at, grain.velocity);
    grain.at[0] = 0, grain.at[1] = r - grid_.z_of(index);
    action(index, 1.0, grain);
  }
  /// Two Gauss points in each ring that a branch crosses.
  template <int D, class Action>
  void each_share(const HalfBranch<D>& branch, Action action) const;

 private:
  /// Components along the tangent and the radius at a place; the centre itself counts as above.
  template <int D>
  static Vector<D> polar(const Vector<D>& at, Vector<D> v) {
    const double r = std::hypot(at[0], at[1]), r_x = r > 0 ? at[0] / r : 0, r_z = r > 0 ? at[1] / r : 1;
    const double along = v[0] * r_z - v[1] * r_x;
    v[1] = v[0] * r_x + v[1] * r_z, v[0] = along;
    return v;
  }
  /// Parameters along a half branch at which it goes from ring to ring, with its ends.
  std::vector<double> cuts_of(double x, double z, double toward_x, double toward_z) const;

  const LayerGrid& grid_;
};

template <int D, class Action>
void LayerBinning::each_part(const GrainSample<D>& grain, Action action) const {
  const double x = grain.at[0], z = grain.at[1];
  const double radius = grain.radius, z_min = grid_.z_min, thickness = grid_.thickness;
  if (x + radius <= grid_.x_min || x - radius >= grid_.x_max) return;
  const auto [first, last] =
      between(std::floor((z - radius - z_min) / thickness), std::ceil((z + radius - z_min) / thickness) - 1);
  const bool cut = x - radius < grid_.x_min || x + radius > grid_.x_max;
  // Between the sides of the slice layers cut the disc into strips: one evaluation a boundary.
  const auto below = [&](double layer) { return part_left_of(grain, z_min + layer * thickness - z); };
  double before = cut ? 0 : below(first);
  for (double layer = first; layer <= last; ++layer) {
    const double up_to = cut ? 0 : below(layer + 1);
    action(index_of(layer),
           cut ? part_in(grain, x, z, grid_.rectangle(static_cast<std::size_t>(layer))) : up_to - before);
    before = up_to;
  }
}

template <int D, class Action>
void LayerBinning::each_share(const HalfBranch<D>& branch, Action action) const {
  const double x = branch.at[0], z = branch.at[1], toward_x = branch.toward[0], toward_z = branch.toward[1];
  if (std::min(x, x + toward_x) > grid_.x_max || std::max(x, x + toward_x) < grid_.x_min) return;
  LinePart between_sides;
  between_sides.cut(x, toward_x, grid_.x_min, grid_.x_max);
  const auto [begin, end] = between_sides;
  if (between_sides.empty()) return;

  const double z_min = grid_.z_min, thickness = grid_.thickness;
  const double low = z + (toward_z > 0 ? begin : end) * toward_z;
  const double high = z + (toward_z > 0 ? end : begin) * toward_z;
  const auto [first, last] =
      between(std::floor((low - z_min) / thickness), std::floor((high - z_min) / thickness));
  for (double layer = first; layer <= last; ++layer) {
    double share = end - begin;
    if (first < last || low < z_min + first * thickness || high > z_min + (last + 1) * thickness) {
      const double bottom = z_min + layer * thickness;
      const double inside = std::min(high, bottom + thickness) - std::max(low, bottom);
      share = std::max(0.0, inside) / std::abs(toward_z);
    }
    action(index_of(layer), share, branch);
  }
}

template <int D, class Action>
void RingBinning::each_part(const GrainSample<D>& grain, Action action) const {
  const double r = std::hypot(grain.at[0], grain.at[1]), radius = grain.radius, thickness = grid_.thickness;
  const double first = std::max(0.0, std::floor((r - radius) / thickness));
  const double end = std::min(static_cast<double>(grid_.layers()), std::ceil((r + radius) / thickness));
  double below = part_in_circle(grain, r, first * thickness);
  for (double ring = first; ring < end; ++ring) {
    const double up_to = part_in_circle(grain, r, (ring + 1) * thickness);
    action(static_cast<std::size_t>(ring), up_to - below);
    below = up_to;
  }
}

template <int D, class Action>
void RingBinning::each_share(const HalfBranch<D>& branch, Action action) const {
  constexpr double gauss_offset = 0.28867513459481288;  // sqrt(3)/6 from the middle of a piece of length 1
  const std::vector<double> cuts = cuts_of(branch.at[0], branch.at[1], branch.toward[0], branch.toward[1]);
  for (std::size_t piece = 0; piece + 1 < cuts.size(); ++piece) {
    const double middle = (cuts[piece] + cuts[piece + 1]) / 2, length = cuts[piece + 1] - cuts[piece];
    const Vector<D> at = branch.point(middle);
    const double ring = std::floor(std::hypot(at[0], at[1]) / grid_.thickness);
    if (!(ring < static_cast<double>(grid_.layers()))) continue;
    for (const double offset : {-gauss_offset, gauss_offset}) {
      HalfBranch<D> seen = branch;
      seen.at = branch.point(middle + offset * length);
      for (Vector<D>* v : {&seen.toward, &seen.force, &seen.normal}) *v = polar<D>(seen.at, *v);
      action(static_cast<std::size_t>(ring), length / 2, seen);
    }
  }
}

}  // namespace drumlin::particles
