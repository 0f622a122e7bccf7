#include "continuum/model/flow_region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "coupling/core/documents/key_reader.hpp"

namespace drumlin::continuum {
namespace {

double cross(const FlowPoint_mm& a, const FlowPoint_mm& b, const FlowPoint_mm& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}
double distance_mm(const FlowPoint_mm& a, const FlowPoint_mm& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}
/// Where the foot of `p` lies on the line from a to b: 0 at a, 1 at b.
double share_along(const FlowPoint_mm& a, const FlowPoint_mm& b, const FlowPoint_mm& p) {
  const double length = distance_mm(a, b);
  return ((b[0] - a[0]) * (p[0] - a[0]) + (b[1] - a[1]) * (p[1] - a[1])) / (length * length);
}
/// Of p from the line from a to b, which has an end.
double distance_to_segment(const FlowPoint_mm& a, const FlowPoint_mm& b, const FlowPoint_mm& p) {
  const double s = std::clamp(share_along(a, b, p), 0.0, 1.0);
  return distance_mm(p, {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])});
}
bool cross_each_other(const FlowPoint_mm& a, const FlowPoint_mm& b, const FlowPoint_mm& c,
                      const FlowPoint_mm& d) {
  const auto between = [](const FlowPoint_mm& p, const FlowPoint_mm& q, const FlowPoint_mm& r) {
    return cross(p, q, r) == 0 && std::min(p[0], q[0]) <= r[0] && r[0] <= std::max(p[0], q[0]) &&
           std::min(p[1], q[1]) <= r[1] && r[1] <= std::max(p[1], q[1]);
  };
  return (cross(a, b, c) * cross(a, b, d) < 0 && cross(c, d, a) * cross(c, d, b) < 0) || between(a, b, c) ||
         between(a, b, d) || between(c, d, a) || between(c, d, b);
}

std::string text_of(const FlowPoint_mm& p) { return fmt::format("[{:g}, {:g}]", p[0], p[1]); }

using Report =
    std::function<void(const std::string& path, const std::string& what, const std::string& allowed)>;

void check_fill(const std::vector<FlowPoint_mm>& fill, const Report& report) {
  constexpr const char* allowed = "an outline that goes round once, anticlockwise";
  const std::size_t n = fill.size();
  if (n < 3) return report("region.fill_mm", fmt::format("has {} points", n), "at least 3 points");
  double area = 0;
  const auto end = [&](std::size_t i) { return fill[(i + 1) % n]; };
  for (std::size_t i = 0; i < n; ++i) {
    if (fill[i] == end(i))
      return report(fmt::format("region.fill_mm.{}", i), "is " + text_of(fill[i]) + ", as is the next",
                    allowed);
    area += 0.5 * (fill[i][0] * end(i)[1] - end(i)[0] * fill[i][1]);
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j)
      if ((j + 1) % n != i && cross_each_other(fill[i], end(i), fill[j], end(j)))
        return report(
            fmt::format("region.fill_mm.{}", j),
            fmt::format("the side from {} crosses that from {}", text_of(fill[j]), text_of(fill[i])),
            allowed);
  if (area <= 0) report("region.fill_mm", "goes round clockwise", allowed);
}

/// Whether the two lie on one line, along a part of it.
bool covers(const FlowSegment& wall, const FlowOpening& opening) {
  const double tolerance = 1e-6 * distance_mm(opening.from_mm, opening.to_mm);
  const double length = distance_mm(wall.from_mm, wall.to_mm);
  const auto off = [&](const FlowPoint_mm& p) {
    return std::abs(cross(wall.from_mm, wall.to_mm, p)) / length;
  };
  if (off(opening.from_mm) > tolerance || off(opening.to_mm) > tolerance) return false;
  const auto [low, high] = std::minmax({share_along(wall.from_mm, wall.to_mm, opening.from_mm),
                                        share_along(wall.from_mm, wall.to_mm, opening.to_mm)});
  return (std::min(high, 1.0) - std::max(low, 0.0)) * length > tolerance;
}

double distance_to_wall(const FlowWall& wall, const FlowPoint_mm& p) {
  if (const auto* circle = std::get_if<FlowCircle>(&wall.shape))
    return std::abs(distance_mm(circle->center_mm, p) - circle->radius_mm);
  const auto& segment = std::get<FlowSegment>(wall.shape);
  return distance_to_segment(segment.from_mm, segment.to_mm, p);
}

void check_opening(const FlowRegion& region, std::size_t k, const Report& report) {
  const FlowOpening& opening = region.openings[k];
  const std::string path = fmt::format("openings.{}", k);
  if (opening.from_mm == opening.to_mm)
    return report(path + ".to_mm", "is " + text_of(opening.to_mm) + ", as is from_mm", "another point");
  bool held = false;
  for (const FlowWall& wall : region.walls) {
    const auto* segment = std::get_if<FlowSegment>(&wall.shape);
    if (segment && covers(*segment, opening))
      return report(path + ".from_mm",
                    "is " + text_of(opening.from_mm) + "; the wall " + wall.name + " has no hole there",
                    "between the ends of walls");
    const double reach = 1e-6 * distance_mm(opening.from_mm, opening.to_mm);
    held = held || distance_to_wall(wall, opening.from_mm) <= reach ||
           distance_to_wall(wall, opening.to_mm) <= reach;
  }
  if (!held)
    report(path + ".from_mm",
           "is " + text_of(opening.from_mm) + "; no wall reaches to either end of the opening",
           "at a wall, or to_mm at one");
}

void check_wall(const FlowRegion& region, std::size_t k, const Report& report) {
  const FlowWall& wall = region.walls[k];
  const std::string path = fmt::format("walls.{}", k);
  if (const auto* segment = std::get_if<FlowSegment>(&wall.shape);
      segment && segment->from_mm == segment->to_mm)
    report(path + ".to_mm", "is " + text_of(segment->to_mm) + ", as is from_mm", "another point");
  if (wall.ends_s && *wall.ends_s < wall.begins_s)
    report(path + ".ends_s", fmt::format("is {:g}, before begins_s", *wall.ends_s), ">= begins_s");
  const auto* circle = std::get_if<FlowCircle>(&wall.shape);
  for (std::size_t i = 0; circle && i < region.fill_mm.size(); ++i)
    if (distance_mm(circle->center_mm, region.fill_mm[i]) > (1 + 1e-6) * circle->radius_mm)
      return report(fmt::format("region.fill_mm.{}", i), "is outside of the circle " + wall.name,
                    fmt::format("at most {:g} from its centre", circle->radius_mm));
}

void check_time(const RegionTime& time, const Report& report) {
  if (time.step_s > time.end_s) report("time.step_s", fmt::format("is {:g}", time.step_s), "<= time.end_s");
  if (time.frames_s.has_value() == time.frames_every_s.has_value())
    return report(time.frames_s ? "time.frames_s" : "time.frames_every_s",
                  time.frames_s ? "excludes frames_every_s" : "is missing",
                  "one of frames_s, frames_every_s");
  if (time.frames_every_s) {
    if (*time.frames_every_s > time.end_s * (1 + 1e-12))
      report("time.frames_every_s", fmt::format("is {:g}", *time.frames_every_s), "<= time.end_s");
    else if (time.end_s > 1e6 * *time.frames_every_s)
      report("time.frames_every_s", fmt::format("is {:g}", *time.frames_every_s), "at most 1e6 frames");
    return;
  }
  for (std::size_t i = 0; i < time.frames_s->size(); ++i) {
    const double frame = (*time.frames_s)[i];
    const std::string path = fmt::format("time.frames_s.{}", i), what = fmt::format("is {:g}", frame);
    if (i > 0 && frame <= (*time.frames_s)[i - 1]) report(path, what, "later than the frame before");
    if (frame > time.end_s * (1 + 1e-12)) report(path, what + ", after the end", "<= time.end_s");
  }
}

}  // namespace

std::vector<double> frames_s(const RegionTime& time) {
  if (time.frames_s) return *time.frames_s;
  std::vector<double> frames;
  for (int k = 0; k * *time.frames_every_s <= time.end_s * (1 + 1e-12); ++k)
    frames.push_back(std::min(k * *time.frames_every_s, time.end_s));
  return frames;
}

void check_region(const Document& document, const FlowRegion& region, std::vector<InputProblem>& problems) {
  const Report report = [&](const std::string& path, const std::string& what, const std::string& allowed) {
    problems.push_back(problem_at(document, path, what, allowed));
  };
  check_fill(region.fill_mm, report);
  for (std::size_t k = 0; k < region.walls.size(); ++k) check_wall(region, k, report);
  for (std::size_t k = 0; k < region.openings.size(); ++k) check_opening(region, k, report);
  check_time(region.time, report);
  for (const auto& [range, path] :
       {std::pair{region.output.x_mm, "output.x_mm"}, {region.output.z_mm, "output.z_mm"}})
    if (range && (*range)[1] <= (*range)[0])
      report(path, fmt::format("is [{:g}, {:g}]", (*range)[0], (*range)[1]), "from below to");
}

}  // namespace drumlin::continuum
