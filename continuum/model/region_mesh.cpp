#include "continuum/model/region_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <queue>

#include "continuum/model/outline.hpp"
#include "continuum/model/plane_vector.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

constexpr int outside = -1;
constexpr double triangle_rounding = 1e-10;
constexpr double flat = 1e-8;  // height over length below which points lie on one line
// Circumradius over size up to which a triangle is small enough: 0.58 in an equilateral one.
constexpr double largest_radius = 0.72;
constexpr double least_height = 0.3;  // of an inner point above a side of the outline, over its length
constexpr int smoothings = 10;
constexpr double least_roundness = 0.2;  // below it smoothing makes no triangle worse

struct Triangle {
  std::array<int, 3> corner;                                // anticlockwise
  std::array<int, 3> beyond = {outside, outside, outside};  // the triangle opposite to each corner
};

// Twice the area over the square of the longest side: 0.87 if equilateral.
double roundness(Vec2 a, Vec2 b, Vec2 c) {
  return cross(b - a, c - a) / std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
}

// Or within a hair of it.
bool holds(Vec2 a, Vec2 b, Vec2 c, Vec2 p) {
  const auto inside = [p](Vec2 from, Vec2 to) {
    return cross(to - from, p - from) >= -flat * dot(to - from, to - from);
  };
  return inside(a, b) && inside(b, c) && inside(c, a);
}

// A polygon of triangles: the best ear is cut off until one is left.
std::vector<Triangle> clipped_ears(const std::vector<Vec2>& points) {
  std::vector<int> ring(points.size());
  for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = static_cast<int>(i);
  const auto ear = [&](std::size_t k) {
    const std::size_t n = ring.size();
    return std::array{ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]};
  };
  const auto worth = [&](std::size_t k) {
    const auto e = ear(k);
    const Vec2 a = points[e[0]], b = points[e[1]], c = points[e[2]];
    const double value = roundness(a, b, c);
    if (value < flat) return 0.0;
    for (const int i : ring)
      if (i != e[0] && i != e[1] && i != e[2] && holds(a, b, c, points[i])) return 0.0;
    return value;
  };
  std::vector<double> worths;
  for (std::size_t k = 0; k < ring.size(); ++k) worths.push_back(worth(k));
  std::vector<Triangle> triangles;
  while (ring.size() > 2) {
    const auto best = std::ranges::max_element(worths);
    const auto k = static_cast<std::size_t>(best - worths.begin());
    if (*best == 0)
      throw NotConvergedError(
          fmt::format("the outline of the material is too thin to be meshed near ({:g}, {:g})",
                      points[ring[k]].x, points[ring[k]].z));
    triangles.push_back({ear(k)});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(k));
    worths.erase(best);
    for (const std::size_t j : {k + ring.size() - 1, k}) worths[j % ring.size()] = worth(j % ring.size());
  }
  return triangles;
}

// Triangles that fill a polygon, its sides among theirs; Delaunay but for those.
class Triangulation {
 public:
  explicit Triangulation(const std::vector<Vec2>& polygon)
      : points_(polygon), triangles_(clipped_ears(polygon)), fixed_(polygon.size()) {
    std::map<std::pair<int, int>, int> known;
    for (int t = 0; t < count(); ++t)
      for (int k = 0; k < 3; ++k) known[{from(t, k), to(t, k)}] = t;
    for (int t = 0; t < count(); ++t)
      for (int k = 0; k < 3; ++k)
        if (const auto at = known.find({to(t, k), from(t, k)}); at != known.end())
          triangles_[t].beyond[k] = at->second;
    flip_all();
  }

  const std::vector<Vec2>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

  // Puts points at circumcentres, the widest triangle first, until all are small or none can be added.
  void refine(const std::function<double(Vec2)>& size) {
    using Entry = std::tuple<double, int, std::array<int, 3>>;
    std::priority_queue<Entry> queue;
    const auto add = [&](int t) {
      const double radius = length(circumcenter(t) - at(t, 0)) / size(centroid(t));
      if (radius > largest_radius) queue.emplace(radius, t, triangles_[t].corner);
    };
    for (int t = 0; t < count(); ++t) add(t);
    while (!queue.empty()) {
      const auto [radius, t, corner] = queue.top();
      queue.pop();
      if (triangles_[t].corner != corner) continue;
      for (const int changed : inserted(t, circumcenter(t))) add(changed);
    }
  }

  // Moves each inner point to the centroid of the triangles about it, smaller ones counted more.
  void smooth(const std::function<double(Vec2)>& size) {
    std::vector<Vec2> sums(points_.size());
    std::vector<double> weights(points_.size()), before_smoothing;
    for (int t = 0; t < count(); ++t) {
      const Vec2 center = centroid(t);
      const double s = size(center), weight = twice_area(t) / (s * s * s * s);
      for (const int c : triangles_[t].corner) sums[c] = sums[c] + weight * center, weights[c] += weight;
      before_smoothing.push_back(roundness_of(t));
    }
    const std::vector<Vec2> before = points_;
    for (std::size_t i = fixed_; i < points_.size(); ++i) points_[i] = (1 / weights[i]) * sums[i];
    for (bool restored = true; restored;) {
      restored = false;
      for (int t = 0; t < count(); ++t)
        if (roundness_of(t) < std::min(least_roundness, before_smoothing[t]))
          for (const int c : triangles_[t].corner)
            if (length(points_[c] - before[c]) > 0) points_[c] = before[c], restored = true;
    }
    flip_all();
  }

 private:
  int count() const { return static_cast<int>(triangles_.size()); }
  Vec2 at(int t, int k) const { return points_[triangles_[t].corner[k % 3]]; }
  int from(int t, int k) const { return triangles_[t].corner[(k + 1) % 3]; }  // of the side opposite to k
  int to(int t, int k) const { return triangles_[t].corner[(k + 2) % 3]; }
  double roundness_of(int t) const { return roundness(at(t, 0), at(t, 1), at(t, 2)); }
  double twice_area(int t) const { return cross(at(t, 1) - at(t, 0), at(t, 2) - at(t, 0)); }
  Vec2 centroid(int t) const { return (1.0 / 3) * (at(t, 0) + at(t, 1) + at(t, 2)); }
  Vec2 circumcenter(int t) const {
    const Vec2 b = at(t, 1) - at(t, 0), c = at(t, 2) - at(t, 0);
    const double s = 0.5 / cross(b, c), bb = dot(b, b), cc = dot(c, c);
    return at(t, 0) + s * Vec2{c.z * bb - b.z * cc, b.x * cc - c.x * bb};
  }

  // Whether the two angles opposite to the side make more than 180 degrees.
  bool is_to_flip(int t, int k) const {
    const int other = triangles_[t].beyond[k];
    if (other == outside) return false;
    const Vec2 a = at(t, k), b = at(t, k + 1), c = at(t, k + 2), d = at(other, opposite(t, other));
    const double sine = cross(b - a, c - a), cosine = dot(b - a, c - a);
    const double far_sine = cross(c - d, b - d), far_cosine = dot(c - d, b - d);
    return sine * far_cosine + cosine * far_sine <
           -triangle_rounding * std::hypot(sine, cosine) * std::hypot(far_sine, far_cosine);
  }
  int opposite(int t, int other) const {  // corner of `other` that faces t
    return static_cast<int>(std::ranges::find(triangles_[other].beyond, t) -
                            triangles_[other].beyond.begin());
  }
  void relink(int t, int old_neighbour, int neighbour) {
    if (t != outside) triangles_[t].beyond[opposite(old_neighbour, t)] = neighbour;
  }

  // (a, b, c) and (d, c, b) become (a, b, d) and (a, d, c).
  void flip(int t, int k) {
    const int other = triangles_[t].beyond[k], l = opposite(t, other);
    const Triangle one = triangles_[t], two = triangles_[other];
    const int a = one.corner[k], b = one.corner[(k + 1) % 3], c = one.corner[(k + 2) % 3], d = two.corner[l];
    const int over_ca = one.beyond[(k + 1) % 3], over_ab = one.beyond[(k + 2) % 3];
    const int over_bd = two.beyond[(l + 1) % 3], over_dc = two.beyond[(l + 2) % 3];
    relink(over_bd, other, t);
    relink(over_ca, t, other);
    triangles_[t] = {{a, b, d}, {over_bd, other, over_ab}};
    triangles_[other] = {{a, d, c}, {over_dc, over_ca, t}};
  }

  // Flips from these triangles on until all is Delaunay; those that have changed are added to the list.
  void flip_from(std::vector<int>& changed) {
    for (std::vector<int> stack = changed; !stack.empty();) {
      const int t = stack.back();
      stack.pop_back();
      for (int k = 0; k < 3; ++k)
        if (is_to_flip(t, k)) {
          const int other = triangles_[t].beyond[k];
          flip(t, k);
          for (const int i : {other, t}) stack.push_back(i), changed.push_back(i);
          break;
        }
    }
  }
  void flip_all() {
    std::vector<int> all;
    for (int t = 0; t < count(); ++t) all.push_back(t);
    flip_from(all);
  }

  // Triangles changed by a new point at p, seen from t; none if it lies beyond the outline, or hardly within.
  std::vector<int> inserted(int t, Vec2 p) {
    for (int k = 0, steps = 0; k < 3;) {
      const Vec2 a = at(t, k + 1), b = at(t, k + 2);
      const double height = cross(b - a, p - a) / dot(b - a, b - a);
      const int next = triangles_[t].beyond[k];
      if (next == outside && height < least_height) return {};
      if (height < -triangle_rounding)
        t = next, k = 0;
      else
        ++k;
      if (++steps > 4 * count()) return {};
    }
    const Triangle old = triangles_[t];
    const int point = static_cast<int>(points_.size()), second = count(), third = second + 1;
    const auto [a, b, c] = old.corner;
    points_.push_back(p);
    relink(old.beyond[0], t, second);
    relink(old.beyond[1], t, third);
    triangles_[t] = {{a, b, point}, {second, third, old.beyond[2]}};
    triangles_.push_back({{b, c, point}, {third, t, old.beyond[0]}});
    triangles_.push_back({{c, a, point}, {t, second, old.beyond[1]}});
    std::vector<int> changed = {t, second, third};
    flip_from(changed);
    return changed;
  }

  std::vector<Vec2> points_;
  std::vector<Triangle> triangles_;
  std::size_t fixed_;  // points of the polygon: the first ones
};

RegionMesh mesh_from(const Triangulation& triangulation, const Outline& outline) {
  RegionMesh mesh{triangulation.points(), {}, {}};
  for (const Triangle& triangle : triangulation.triangles()) {
    const auto& [a, b, c] = triangle.corner;
    mesh.triangles.push_back({static_cast<unsigned>(a), static_cast<unsigned>(b), static_cast<unsigned>(c)});
  }
  const auto n = static_cast<unsigned>(outline.points.size());
  for (unsigned i = 0; i < n; ++i) mesh.boundary.push_back({i, (i + 1) % n, outline.part[i]});
  return mesh;
}

}  // namespace

RegionMesh mesh_of(const Outline& outline, const std::function<double(Vec2)>& size) {
  if (const auto sides = crossing_of(outline))
    throw NotConvergedError(fmt::format("the outline of the material crosses itself at ({:g}, {:g})",
                                        outline.points[sides->second].x, outline.points[sides->second].z));
  if (!(area(outline) > 0)) throw NotConvergedError("the outline of the material runs clockwise");
  Triangulation triangulation(outline.points);
  triangulation.refine(size);
  for (int k = 0; k < smoothings; ++k) triangulation.smooth(size);
  return mesh_from(triangulation, outline);
}

RegionMesh mesh_of(std::span<const Outline> outlines, const std::function<double(Vec2)>& size) {
  RegionMesh whole;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (meet(outlines[i], outlines[j]))
        throw NotConvergedError(
            fmt::format("pieces of the material that had broken meet again near ({:g}, {:g})",
                        outlines[i].points[0].x, outlines[i].points[0].z));
    const RegionMesh piece = mesh_of(outlines[i], size);
    const auto first = static_cast<unsigned>(whole.vertices.size());
    whole.vertices.insert(whole.vertices.end(), piece.vertices.begin(), piece.vertices.end());
    for (const auto& [a, b, c] : piece.triangles)
      whole.triangles.push_back({a + first, b + first, c + first});
    for (const auto& edge : piece.boundary)
      whole.boundary.push_back({edge.from + first, edge.to + first, edge.part});
  }
  return whole;
}

std::vector<Outline> outlines_of(const RegionMesh& mesh) {
  std::vector<Outline> outlines;
  unsigned int next = 0;
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    const auto& edge = mesh.boundary[i];
    if (i == 0 || edge.from != next) outlines.emplace_back();
    outlines.back().points.push_back(mesh.vertices[edge.from]);
    outlines.back().part.push_back(edge.part);
    next = edge.to;
  }
  return outlines;
}

std::vector<std::size_t> sides_before(const RegionMesh& mesh) {
  std::vector<std::size_t> ending(mesh.vertices.size()), before;
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) ending[mesh.boundary[i].to] = i;
  for (const auto& edge : mesh.boundary) before.push_back(ending[edge.from]);
  return before;
}

double quality(const RegionMesh& mesh) {
  double least = 1;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec2 a = mesh.vertices[i], b = mesh.vertices[j], c = mesh.vertices[k];
    const double squares = dot(b - a, b - a) + dot(c - b, c - b) + dot(a - c, a - c);
    least = std::min(least, 2 * std::sqrt(3.0) * cross(b - a, c - a) / squares);
  }
  return least;
}

}  // namespace drumlin::continuum
