#include "continuum/model/touch_down.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "continuum/model/outline_pieces.hpp"
#include "continuum/model/plane_vector.hpp"
#include "continuum/model/wall_path.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

constexpr double film = 0.02, touching = 0.01, near_wall = 0.1, deepest = 2;  // heights above a wall in sizes
constexpr double same_point = 1e-6;                                           // d
constexpr double gap = 0.5;                                                   // size^2
constexpr int most_rounds = 100;

// The outline seen from a contact: it is point 0, the sides from there on are free, those before it on a
// part.
struct Front {
  std::vector<Vec2> points;
  std::vector<int> part;
  double hand = 1;  // the material lies on the left, or, turned round, on the right
  double size = 0;
  std::size_t free_sides = 0;
  std::vector<PathPiece> path = {};  // of the wall that goes on
};

// All fronts, each contact once.
std::vector<Front> fronts_of(const Outline& outline, const Region& region, double time,
                             const SizeField& size) {
  std::vector<Front> fronts;
  const std::size_t n = outline.points.size();
  const auto is_free = [&](std::size_t side) { return outline.part[side % n] == Outline::free; };
  std::vector<Vec2> contacts;
  for (std::size_t i = 0; i < n; ++i)
    if (is_free(i) != is_free(i + n - 1)) contacts.push_back(outline.points[i]);
  for (std::size_t i = 0; i < n; ++i) {
    if (is_free(i) == is_free(i + n - 1)) continue;
    Front front{{}, {}, is_free(i) ? 1.0 : -1.0, size(outline.points[i])};
    for (std::size_t j = 0; j < n; ++j) {
      front.points.push_back(outline.points[(is_free(i) ? i + j : i + n - j) % n]);
      front.part.push_back(outline.part[(is_free(i) ? i + j : i + 2 * n - j - 1) % n]);
    }
    while (front.part[front.free_sides] == Outline::free) ++front.free_sides;
    const PartLine line = line_of(region.parts[front.part.back()], time);
    const Vec2 contact = front.points[0], before = front.points.back();
    const double sense = line.round() ? front.hand : dot(line.along, contact - before) < 0 ? -1 : 1;
    std::vector<Vec2> stops;
    for (const Vec2 other : contacts)
      if (length(other - contact) > 0) stops.push_back(other);
    front.path = path_from(region, time, front.part.back(), contact, sense, front.hand, stops);
    fronts.push_back(std::move(front));
  }
  return fronts;
}

// Anticlockwise again.
Outline outline_from(const Front& front) {
  Outline outline{front.points, front.part};
  if (front.hand < 0) {
    std::ranges::reverse(outline.points);
    std::ranges::reverse(outline.part);
    std::ranges::rotate(outline.part, outline.part.begin() + 1);
  }
  return outline;
}

// The contact `along` the piece of the path, the free points before `kept` left out; all of them if that is
// where the surface ends.
Front landed(const Front& front, std::size_t kept, std::size_t piece, double along) {
  Front next{{}, {}, front.hand};
  const Vec2 contact = front.path[piece].at(along);
  const bool closed = length(contact - front.points[front.free_sides]) < same_point;
  if (closed)
    kept = front.free_sides;
  else
    next.points.push_back(contact), next.part.push_back(Outline::free);
  const auto from = static_cast<std::ptrdiff_t>(kept);
  next.points.insert(next.points.end(), front.points.begin() + from, front.points.end());
  next.part.insert(next.part.end(), front.part.begin() + from, front.part.end());
  const auto add = [&](Vec2 point, int part) { next.points.push_back(point), next.part.push_back(part); };
  for (std::size_t k = 0; k <= piece; ++k) {
    const PathPiece& way = front.path[k];
    const double end = k == piece ? along : way.length();
    const double steps = way.line.round() ? std::ceil(end / front.size) : end > 0 ? 1 : 0;
    for (double i = 0; i < steps; ++i)
      add(i > 0 || k > 0 ? way.at(i / steps * end) : front.points[0], way.part);
  }
  return next;
}

// Back along the wet wall if the first free point has all but come down to it.
std::optional<Front> slid_back(const Front& front) {
  const auto& p = front.points;
  if (front.free_sides < 2) return {};
  const double reach = 2 * length(p[1] - p[0]);
  double way = 0;
  for (std::size_t j = p.size() - 1; way < reach && front.part[j] != Outline::free; --j) {
    const Vec2 a = p[j], side = p[(j + 1) % p.size()] - a, along = (1 / length(side)) * side;
    const double s = dot(along, p[1] - a), height = front.hand * cross(along, p[1] - a);
    way += length(side);
    if (s < 0 || s >= length(side) || height > film * front.size || height < -deepest * front.size) continue;
    // Where the triangle of the contact and the first two free points has the same area.
    const double second = front.hand * cross(along, p[2] - a);
    double place = s;
    if (second > near_wall * front.size && j + 1 == p.size())
      place =
          std::clamp(length(side) + front.hand * cross(p[1] - p[0], p[2] - p[0]) / second, s, length(side));
    Front next = front;
    const auto end = static_cast<std::ptrdiff_t>(place > 0 ? j + 1 : j);
    next.points.assign({a + place * along});
    next.part.assign({Outline::free});
    next.points.insert(next.points.end(), p.begin() + 2, p.begin() + end);
    next.part.insert(next.part.end(), front.part.begin() + 2, front.part.begin() + end);
    return next;
  }
  return {};
}

// On along the dry wall, so far that the area stays.
std::optional<Front> rolled_over(const Front& front, const Region& region, double time, double angle) {
  const auto& p = front.points;
  if (front.free_sides < 2 || front.path.empty() || is_open(region.parts[front.path[0].part], time))
    return {};
  const Vec2 side = p[1] - p[0], ahead = front.path[0].direction(0);
  if (std::atan2(front.hand * cross(ahead, side), dot(ahead, side)) >= angle) return {};
  double rest = front.hand * cross(side, p[2] - p[0]);
  const double farthest = length(side) + length(p[2] - p[1]);
  for (std::size_t k = 0;; ++k) {
    const PathPiece& piece = front.path[k];
    const Vec2 from = piece.at(0), to = piece.at(piece.length());
    const double second = front.hand * cross(piece.direction(0), p[2] - from);
    const double way = second > near_wall * front.size ? rest / second : dot(piece.direction(0), p[1] - from);
    const bool last = k + 1 == front.path.size() || is_open(region.parts[front.path[k + 1].part], time);
    if (way <= piece.length() || last)
      return landed(front, 2, k, std::clamp(way, 0.0, std::min(piece.length(), farthest)));
    rest -= front.hand * cross(to - from, p[2] - from);
  }
}

double area_between(const Front& before, const Front& after) {
  return area(outline_from(after)) - area(outline_from(before));
}

struct Height {
  double along, above;  // of a point, from the start of a piece and its line; the material's side is above
};
Height height_over(const PathPiece& piece, double hand, Vec2 point) {
  double s = piece.sense() * (piece.line.nearest(point) - piece.from);
  if (piece.line.round() && s < 0) s += piece.line.length;
  return {s, hand * cross(piece.direction(s), point - piece.at(s))};
}
// Whether it lies below that height, over the piece and not far behind it.
bool has_come_to(const PathPiece& piece, const Front& front, Vec2 point, double least) {
  const Height height = height_over(piece, front.hand, point);
  return height.along >= 0 && height.along <= piece.length() && height.above < least &&
         height.above > -deepest * front.size;
}

// The last free point that has come to the wall that goes on takes the contact there.
std::optional<Front> touched(const Front& front, const Region& region, double time) {
  for (std::size_t k = front.free_sides - 1; k >= 1; --k)
    for (std::size_t i = 0; i < front.path.size(); ++i)
      if (const PathPiece& piece = front.path[i];
          !is_open(region.parts[piece.part], time) &&
          has_come_to(piece, front, front.points[k], touching * front.size))
        return landed(front, k + 1, i, height_over(piece, front.hand, front.points[k]).along);
  return {};
}

// The free points that have passed an opening at the end of the way; the opening is wet from where the
// surface goes through it to where it comes back.
std::optional<Front> cut_off(const Front& front, const Region& region, double time) {
  const auto& p = front.points;
  if (front.path.empty() || !is_open(region.parts[front.path.back().part], time)) return {};
  const PathPiece& piece = front.path.back();
  const auto passed = [&](std::size_t k) { return has_come_to(piece, front, p[k], 0); };
  std::size_t last = front.free_sides - 1;
  while (last > 0 && !passed(last)) --last;
  if (last == 0) return {};
  std::size_t first = last;
  while (first > 1 && passed(first - 1)) --first;
  const auto crossing = [&](std::size_t inside, std::size_t beyond) {
    const double height = height_over(piece, front.hand, p[inside]).above;
    const double depth = height_over(piece, front.hand, p[beyond]).above;
    const Vec2 point = p[inside] + std::clamp(height / (height - depth), 0.0, 1.0) * (p[beyond] - p[inside]);
    return piece.at(std::clamp(height_over(piece, front.hand, point).along, 0.0, piece.length()));
  };
  const Vec2 out = crossing(first - 1, first), back = crossing(last + 1, last);
  Front next{{}, {}, front.hand};
  const auto add = [&](Vec2 point, int part) { next.points.push_back(point), next.part.push_back(part); };
  for (std::size_t j = 0; j < first; ++j) add(p[j], Outline::free);
  if (length(out - p[first - 1]) > same_point) add(out, piece.part);
  next.part.back() = piece.part;
  if (length(back - p[last + 1]) > same_point) add(back, Outline::free);
  for (std::size_t j = last + 1; j < p.size(); ++j) add(p[j], front.part[j]);
  return next;
}

// Little air between the contacts of a surface.
std::optional<Front> closed_up(const Front& front) {
  if (front.path.empty()) return {};
  const double end = front.path.back().length();
  if (length(front.path.back().at(end) - front.points[front.free_sides]) > same_point) return {};
  const Front next = landed(front, front.free_sides, front.path.size() - 1, end);
  return area_between(front, next) < gap * front.size * front.size ? std::optional(next) : std::nullopt;
}

// One change of one front; what has come to a wall far from its contacts is told by `far`.
std::optional<Outline> one_step(const std::vector<Front>& fronts, const Region& region, double time,
                                double angle, double& passed, std::optional<Vec2>& far) {
  for (const Front& front : fronts)
    if (const auto next = cut_off(front, region, time)) {
      passed -= area_between(front, *next);
      return outline_from(*next);
    }
  for (const Front& front : fronts) {
    if (const auto next = closed_up(front)) return outline_from(*next);
    if (const auto next = slid_back(front)) return outline_from(*next);
    if (const auto next = rolled_over(front, region, time, angle)) return outline_from(*next);
    const auto next = touched(front, region, time);
    if (!next) continue;
    const double air = area_between(front, *next), whole = area(outline_from(front));
    if (air < largest_bubble(front.size, whole)) return outline_from(*next);
    far = next->points[0];
  }
  return {};
}

// Air in a notch of the free surface sharper than this is closed: its sides would meet in a step or two.
constexpr double sharpest_notch_deg = 40;
// A tip away from contacts that is sharper and smaller than this is cut off: a grain holds on to no others
// there, and what bears it would be tension.
constexpr double sharpest_tip_deg = 60, largest_tip = 1;  // size^2

Outline without_points(Outline outline, const std::function<bool(const Outline&, std::size_t)>& goes) {
  auto& [points, part] = outline;
  for (std::size_t i = 0, checked = 0; checked < points.size() && points.size() > 3;) {
    const std::size_t n = points.size(), before = (i + n - 1) % n;
    if (part[before] == Outline::free && part[i] == Outline::free && goes(outline, i)) {
      points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
      part.erase(part.begin() + static_cast<std::ptrdiff_t>(i));
      i = before < i ? before : before - 1;
      checked = 0;
      continue;
    }
    i = (i + 1) % n;
    ++checked;
  }
  return outline;
}

// Twice the area that goes with the point, positive if it is air, if the sides there are that sharp.
std::optional<double> sharp_at(const Outline& outline, std::size_t i, double angle_deg) {
  const std::size_t n = outline.points.size();
  const Vec2 u = outline.points[(i + n - 1) % n] - outline.points[i],
             v = outline.points[(i + 1) % n] - outline.points[i];
  if (dot(u, v) <= std::cos(angle_deg * std::numbers::pi / 180) * length(u) * length(v)) return {};
  return cross(u, v);
}

Outline without_notches(const Outline& outline) {
  return without_points(outline, [](const Outline& now, std::size_t i) {
    return sharp_at(now, i, sharpest_notch_deg).value_or(-1) > 0;
  });
}

Outline without_tips(const Outline& outline, const SizeField& size) {
  return without_points(outline, [&](const Outline& now, std::size_t i) {
    const std::size_t n = now.points.size();
    const bool at_contact =
        now.part[(i + n - 2) % n] != Outline::free || now.part[(i + 1) % n] != Outline::free;
    const double here = size(now.points[i]), air = sharp_at(now, i, sharpest_tip_deg).value_or(0);
    return !at_contact && air < 0 && air > -2 * largest_tip * here * here;
  });
}

// Each step takes at least one free point away.
Outline with_fronts_laid(Outline outline, const Region& region, double time, const SizeField& size,
                         double angle, double& passed) {
  for (;;) {
    std::optional<Vec2> far;
    const auto next = one_step(fronts_of(outline, region, time, size), region, time, angle, passed, far);
    if (next) {
      outline = *next;
      continue;
    }
    if (far)
      throw NotConvergedError(
          fmt::format("the material has come to a wall at ({:g}, {:g}), far from its "
                      "contacts: so much air is not closed",
                      far->x, far->z));
    return outline;
  }
}

}  // namespace

LaidDown laid_down(const Outline& outline, const Region& region, double time, const SizeField& size,
                   double angle_deg) {
  LaidDown laid;
  std::vector<Outline> rest = {outline};
  for (int rounds = 0; !rest.empty(); ++rounds) {
    if (rounds > most_rounds) throw NotConvergedError("the material falls into too many pieces");
    const Outline next = with_contacts_on_walls(without_notches(rest.back()), region, time);
    rest.pop_back();
    OutlinePieces pieces = pieces_of(next, region, time, size);
    laid.passed += pieces.passed;
    if (pieces.outlines.size() > 1) {
      rest.insert(rest.end(), pieces.outlines.begin(), pieces.outlines.end());
      continue;
    }
    Outline settled = without_tips(with_fronts_laid(std::move(pieces.outlines[0]), region, time, size,
                                                    angle_deg * std::numbers::pi / 180, laid.passed),
                                   size);
    (crossing_of(settled) ? rest : laid.outlines).push_back(std::move(settled));
  }
  return laid;
}

}  // namespace drumlin::continuum
