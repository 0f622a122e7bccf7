#include "continuum/model/outline_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "continuum/model/part_line.hpp"
#include "continuum/model/plane_vector.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

constexpr double opening_film = 0.2, just_past = 1e-3, deepest_past = 2;  // heights above an opening, sizes
constexpr double smallest = 1;                                            // area of a piece, size^2
constexpr double one_place = 1e-9;                                        // d
constexpr int most_cuts = 100;

// Free points close above an opening with material in it put just beyond it.
Outline with_films_passed(Outline outline, const Region& region, double time, const SizeField& size) {
  auto& [points, part] = outline;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (part[i] == Outline::free || !is_open(region.parts[static_cast<std::size_t>(part[i])], time)) continue;
    const Vec2 from = points[i], side = points[(i + 1) % n] - from, along = (1 / length(side)) * side;
    for (std::size_t k = 0; k < n; ++k) {
      if (part[k] != Outline::free || part[(k + n - 1) % n] != Outline::free) continue;
      const Vec2 r = points[k] - from;
      const double s = dot(along, r), height = cross(along, r), here = size(points[k]);
      if (s >= 0 && s <= length(side) && height < opening_film * here && height > -deepest_past * here)
        points[k] = from + s * along + std::min(height, -just_past * here) * Vec2{-along.z, along.x};
    }
  }
  return outline;
}

Outline without_points_twice(Outline outline) {
  auto& [points, part] = outline;
  for (std::size_t i = 0; i < points.size();)
    if (length(points[(i + 1) % points.size()] - points[i]) < one_place) {
      points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
      part.erase(part.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  return outline;
}

Vec2 place_of(const Outline& outline, Crossing at) {
  const auto point = [&](std::size_t i) { return outline.points[i % outline.points.size()]; };
  const Vec2 a = point(at.first), u = point(at.first + 1) - a, c = point(at.second),
             v = point(at.second + 1) - c;
  const double sine = cross(u, v);
  if (std::abs(sine) < one_place * length(u) * length(v)) return c;
  return a + cross(c - a, v) / sine * u;
}

// Points from `place` on, which lies on the sides `first` and `last`, as a ring.
Outline loop(const Outline& outline, Vec2 place, std::size_t first, std::size_t last) {
  const std::size_t n = outline.points.size();
  Outline ring{{place}, {outline.part[first]}};
  for (std::size_t k = (first + 1) % n;; k = (k + 1) % n) {
    ring.points.push_back(outline.points[k]);
    ring.part.push_back(outline.part[k]);
    if (k == last) return ring;
  }
}

struct Loops {
  std::vector<Outline> simple;
  bool at_opening = false;
};

Loops loops_of(const Outline& outline, const Region& region, double time) {
  Loops found;
  std::vector<Outline> rest = {outline};
  for (int cuts = 0; !rest.empty(); ++cuts) {
    Outline ring = without_points_twice(std::move(rest.back()));
    rest.pop_back();
    if (ring.points.size() < 3) continue;
    const auto crossing = crossing_of(ring);
    if (!crossing) {
      found.simple.push_back(std::move(ring));
      continue;
    }
    if (cuts > most_cuts)
      throw NotConvergedError(fmt::format("the outline of the material crosses itself at ({:g}, {:g})",
                                          ring.points[crossing->second].x, ring.points[crossing->second].z));
    const auto [first, second] = *crossing;
    if (second == (first + 1) % ring.points.size()) {  // it turns back there
      ring.points.erase(ring.points.begin() + static_cast<std::ptrdiff_t>(second));
      ring.part.erase(ring.part.begin() + static_cast<std::ptrdiff_t>(second));
      rest.push_back(std::move(ring));
      continue;
    }
    for (const std::size_t side : {first, second})
      if (const int part = ring.part[side];
          part != Outline::free && is_open(region.parts[static_cast<std::size_t>(part)], time))
        found.at_opening = true;
    const Vec2 place = place_of(ring, *crossing);
    rest.push_back(loop(ring, place, first, second));
    rest.push_back(loop(ring, place, second, first));
  }
  return found;
}

bool lies_in(Vec2 point, const Outline& outline) {
  bool inside = false;
  const std::size_t n = outline.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 a = outline.points[i], b = outline.points[(i + 1) % n];
    if ((a.z > point.z) != (b.z > point.z) && point.x < a.x + (point.z - a.z) / (b.z - a.z) * (b.x - a.x))
      inside = !inside;
  }
  return inside;
}

Vec2 middle_of(const Outline& outline) {
  Vec2 sum;
  for (const Vec2 point : outline.points) sum = sum + point;
  return (1.0 / static_cast<double>(outline.points.size())) * sum;
}

}  // namespace

double largest_bubble(double size, double area) { return std::max(16 * size * size, 0.05 * area); }

OutlinePieces pieces_of(const Outline& outline, const Region& region, double time, const SizeField& size) {
  const Loops loops = loops_of(with_films_passed(outline, region, time, size), region, time);
  const double whole = area(outline);
  OutlinePieces pieces;
  for (const Outline& ring : loops.simple) {
    const double inside = area(ring), here = size(ring.points[0]);
    if (!loops.at_opening && -inside > largest_bubble(here, whole))
      throw NotConvergedError(
          fmt::format("the material closes in air at ({:g}, {:g})", ring.points[0].x, ring.points[0].z));
    const bool twice = std::ranges::any_of(loops.simple, [&](const Outline& other) {
      return &other != &ring && area(other) > inside && lies_in(middle_of(ring), other);
    });
    if (inside > smallest * here * here && !twice) pieces.outlines.push_back(ring);
  }
  if (pieces.outlines.empty()) throw NotConvergedError("nothing is left of the material");
  if (loops.at_opening) {
    pieces.passed = whole;
    for (const Outline& piece : pieces.outlines) pieces.passed -= area(piece);
  }
  return pieces;
}

}  // namespace drumlin::continuum
