#include "continuum/model/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "continuum/model/part_line.hpp"
#include "continuum/model/plane_vector.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

// Whether the line through a and b has p and q on different sides, or one of them on it.
bool parts_points(Vec2 a, Vec2 b, Vec2 p, Vec2 q) {
  const double first = cross(b - a, p - a), second = cross(b - a, q - a);
  return (first <= 0 && second >= 0) || (first >= 0 && second <= 0);
}

bool overlap(double a, double b, double c, double d) {
  return std::max(std::min(a, b), std::min(c, d)) <= std::min(std::max(a, b), std::max(c, d));
}

bool sides_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  return overlap(a.x, b.x, c.x, d.x) && overlap(a.z, b.z, c.z, d.z) && parts_points(a, b, c, d) &&
         parts_points(c, d, a, b);
}

constexpr double on_line = 1e-6;                 // of the length of a side
constexpr double longest = 1.5, shortest = 0.5;  // free sides, in sizes
constexpr double at_corner = 0.1;                // sizes

struct Stretch {  // of a side, in shares of it
  double begins, ends;
  int part;
};

// Part of the side from a to b that lies on the part, if any does. `before`: the part on which it lay.
std::optional<Stretch> stretch_on(const Region& region, int part, double time, Vec2 a, Vec2 b, int before) {
  const PartLine line = line_of(region.parts[part], time);
  const double tolerance = on_line * length(b - a);
  if (part != before && std::max(line.distance(a), line.distance(b)) > tolerance) return {};
  if (line.round()) {
    const Vec2 from = a - line.start, to = b - line.start;
    if (part != before && (cross(from, to) < 0 || cross(from, to) > dot(from, to))) return {};
    return Stretch{0, 1, part};
  }
  const double from = line.nearest(a), step = line.nearest(b) - from;
  if (std::abs(step) <= tolerance) return {};
  const auto [begins, ends] = std::minmax({-from / step, (line.length - from) / step});
  if (std::min(ends, 1.0) - std::max(begins, 0.0) <= on_line) return {};
  return Stretch{begins, ends, part};
}

std::vector<Stretch> stretches_of(const Region& region, double time, Vec2 a, Vec2 b, int before) {
  std::vector<Stretch> all;
  for (std::size_t k = 0; k < region.parts.size(); ++k)
    if (is_there(region.parts[k], time))
      if (const auto found = stretch_on(region, static_cast<int>(k), time, a, b, before))
        all.push_back(*found);
  std::ranges::stable_partition(all, [&](const Stretch& stretch) {
    return region.parts[stretch.part].kind == RegionPart::Kind::opening;
  });
  return all;
}

// Shares from 0 on, without 1, that divide a line evenly by the size on it.
std::vector<double> even_shares(double length, const std::function<Vec2(double)>& at, const SizeField& size) {
  std::vector<double> shares = {0}, counts = {0};
  while (shares.back() < 1) {
    const double here = size(at(shares.back())), step = std::min(0.1 * here / length, 1 - shares.back());
    counts.push_back(counts.back() + step * length / size(at(shares.back() + 0.5 * step)));
    shares.push_back(step < 1 - shares.back() ? shares.back() + step : 1);
  }
  const double pieces = std::max(1.0, std::round(counts.back()));
  std::vector<double> found = {0};
  for (double i = 1; i < pieces; ++i) {
    const double wanted = i / pieces * counts.back();
    const auto k = static_cast<std::size_t>(std::ranges::upper_bound(counts, wanted) - counts.begin());
    const double part = (wanted - counts[k - 1]) / (counts[k] - counts[k - 1]);
    found.push_back(shares[k - 1] + part * (shares[k] - shares[k - 1]));
  }
  return found;
}

void add_straight(Outline& outline, Vec2 a, Vec2 b, int part, const SizeField& size) {
  const auto at = [&](double share) { return a + share * (b - a); };
  for (const double share : even_shares(length(b - a), at, size))
    outline.points.push_back(at(share)), outline.part.push_back(part);
}

// Anticlockwise from a to b, or all round.
void add_chords(Outline& outline, const PartLine& circle, Vec2 a, Vec2 b, int part, const SizeField& size) {
  const double from = circle.nearest(a);
  double way = circle.nearest(b) - from;
  if (way <= 0) way += circle.length;
  const auto at = [&](double share) { return share > 0 ? circle.at(from + share * way) : a; };
  for (const double share : even_shares(way, at, size))
    outline.points.push_back(at(share)), outline.part.push_back(part);
}

// Points of a free chain with its ends: long sides halved, as long as there are any.
std::vector<Vec2> refined(std::vector<Vec2> chain, const SizeField& size) {
  for (bool halved = true; halved;) {
    halved = false;
    std::vector<Vec2> next = {chain[0]};
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const Vec2 a = chain[i - 1], b = chain[i];
      Vec2 middle = 0.5 * (a + b);
      if (length(b - a) > longest * size(middle)) {
        if (i >= 2 && i + 1 < chain.size()) {
          const Vec2 bow = (1.0 / 16) * (a + b - chain[i + 1] - chain[i - 2]);
          if (length(bow) < 0.1 * length(b - a)) middle = middle + bow;
        }
        next.push_back(middle);
        halved = true;
      }
      next.push_back(b);
    }
    chain = std::move(next);
  }
  return chain;
}

// Points k and k + 1 become one near `place` that keeps the area.
void merge(std::vector<Vec2>& chain, std::size_t k, Vec2 place, double size) {
  const Vec2 a = chain[k - 1], chord = chain[k + 2] - a;
  const double wanted = cross(chain[k] - a, chain[k + 1] - a) + cross(chain[k + 1] - a, chord);
  const double miss = (wanted - cross(place - a, chord)) / dot(chord, chord);
  const Vec2 shift = miss * Vec2{chord.z, -chord.x};
  chain[k] = length(shift) < size ? place + shift : place;
  chain.erase(chain.begin() + static_cast<std::ptrdiff_t>(k) + 1);
}

// Points of a free chain with its ends, which stay: short sides shrunk to a point.
std::vector<Vec2> thinned(std::vector<Vec2> chain, const SizeField& size) {
  for (std::size_t i = 1; i + 1 < chain.size();) {
    const double here = size(chain[i]);
    const auto near = [&](std::size_t k) { return length(chain[k + 1] - chain[k]) < shortest * here; };
    const bool is_last = i + 2 == chain.size();
    if (!near(i - 1) && !(is_last && near(i))) {
      ++i;
    } else if (i > 1) {
      merge(chain, i - 1, chain[i - 1], here);
      if (is_last) --i;
    } else if (!is_last) {
      merge(chain, i, chain[i + 1], here);
    } else {
      chain.erase(chain.begin() + 1);
    }
  }
  return chain;
}

// Points where the part changes; the first point if it does nowhere.
std::vector<std::size_t> chain_starts(const Outline& outline) {
  std::vector<std::size_t> starts;
  const std::size_t n = outline.points.size();
  for (std::size_t i = 0; i < n; ++i)
    if (outline.part[i] != outline.part[(i + n - 1) % n]) starts.push_back(i);
  if (starts.empty()) starts.push_back(0);
  return starts;
}

// The part on which a contact lies; free: it is none.
int wall_of_contact(const Outline& outline, std::size_t i) {
  const int before = outline.part[(i + outline.part.size() - 1) % outline.part.size()],
            after = outline.part[i];
  return (before == Outline::free) == (after == Outline::free) ? Outline::free : std::max(before, after);
}

// Contacts closer to a corner of the walls than a tenth of the size go there.
Outline with_contacts_at_corners(Outline outline, const SizeField& size) {
  auto& [points, part] = outline;
  for (std::size_t i = points.size(); i-- > 0 && points.size() > 3;) {
    const std::size_t n = points.size();
    const bool free_after = part[i] == Outline::free;
    const std::size_t corner = (free_after ? i + n - 1 : i + 1) % n,
                      beyond = free_after ? (i + n - 2) % n : corner;
    const int wall = wall_of_contact(outline, i);
    if (wall == Outline::free || part[beyond] == Outline::free || part[beyond] == wall) continue;
    if (length(points[corner] - points[i]) > at_corner * size(points[i])) continue;
    if (free_after) part[corner] = Outline::free;
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
    part.erase(part.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return outline;
}

// Way of each point while the free ones move out by 1: along the walls, contacts keep pace unless the wall
// and the surface are within 17 deg.
std::vector<Vec2> ways_outward(const Outline& outline, const Region& region, double time) {
  const std::size_t n = outline.points.size();
  std::vector<Vec2> ways(n);
  for (std::size_t i = 0; i < n; ++i) {
    const bool free_before = outline.part[(i + n - 1) % n] == Outline::free;
    const bool free_after = outline.part[i] == Outline::free;
    if (!free_before && !free_after) continue;
    const Vec2 from = outline.points[free_before ? (i + n - 1) % n : i];
    const Vec2 chord = outline.points[free_after ? (i + 1) % n : i] - from;
    const Vec2 normal = (1 / length(chord)) * Vec2{chord.z, -chord.x};
    ways[i] = normal;
    if (const int part = wall_of_contact(outline, i); part != Outline::free) {
      const PartLine line = line_of(region.parts[part], time);
      const Vec2 tangent = line.tangent(line.nearest(outline.points[i]));
      const double share = dot(normal, tangent);
      ways[i] = std::abs(share) > 0.3 ? (1 / share) * tangent : Vec2{0, 0};
    }
  }
  return ways;
}

// A contact goes at most half of the side by which it stands on its wall.
std::vector<double> bounds_of_contacts(const Outline& outline, const std::vector<Vec2>& ways) {
  const std::size_t n = outline.points.size();
  std::vector<double> bounds(n, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < n; ++i)
    if (wall_of_contact(outline, i) != Outline::free && length(ways[i]) > 0) {
      const std::size_t on_wall = outline.part[i] == Outline::free ? (i + n - 1) % n : (i + 1) % n;
      bounds[i] = 0.5 * length(outline.points[on_wall] - outline.points[i]) / length(ways[i]);
    }
  return bounds;
}

}  // namespace

Outline outline_of(const Region& region, double time, const SizeField& size) {
  const Outline fill =
      relabelled({region.fill, std::vector<int>(region.fill.size(), Outline::free)}, region, time);
  Outline divided;
  for (std::size_t i = 0; i < fill.points.size(); ++i) {
    const Vec2 a = fill.points[i], b = fill.points[(i + 1) % fill.points.size()];
    if (fill.part[i] == Outline::free)
      add_straight(divided, a, b, fill.part[i], size);
    else
      divided.points.push_back(a), divided.part.push_back(fill.part[i]);
  }
  return resampled(divided, region, time, size);
}

Outline relabelled(const Outline& outline, const Region& region, double time) {
  Outline cut;
  for (std::size_t i = 0; i < outline.points.size(); ++i) {
    const Vec2 a = outline.points[i], b = outline.points[(i + 1) % outline.points.size()];
    const auto stretches = stretches_of(region, time, a, b, outline.part[i]);
    std::vector<double> cuts = {0};
    for (const Stretch& stretch : stretches)
      for (const double share : {stretch.begins, stretch.ends})
        if (share > on_line && share < 1 - on_line) cuts.push_back(share);
    std::ranges::sort(cuts);
    cuts.erase(std::unique(cuts.begin(), cuts.end(), [](double u, double v) { return v - u < on_line; }),
               cuts.end());
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const double middle = 0.5 * (cuts[k] + (k + 1 < cuts.size() ? cuts[k + 1] : 1));
      const auto found = std::ranges::find_if(
          stretches, [&](const Stretch& s) { return s.begins < middle && middle < s.ends; });
      cut.points.push_back(a + cuts[k] * (b - a));
      cut.part.push_back(found == stretches.end() ? Outline::free : found->part);
    }
  }
  return cut;
}

Outline resampled(const Outline& old, const Region& region, double time, const SizeField& size) {
  const Outline outline = with_contacts_at_corners(with_contacts_on_walls(old, region, time), size);
  const std::size_t n = outline.points.size();
  const auto starts = chain_starts(outline);
  Outline fresh;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const std::size_t first = starts[k], last = k + 1 < starts.size() ? starts[k + 1] : starts[0] + n;
    const int part = outline.part[first];
    const Vec2 a = outline.points[first], b = outline.points[last % n];
    if (part == Outline::free) {
      std::vector<Vec2> chain;
      for (std::size_t i = first; i <= last; ++i) chain.push_back(outline.points[i % n]);
      chain = thinned(refined(chain, size), size);
      fresh.points.insert(fresh.points.end(), chain.begin(), chain.end() - 1);
      fresh.part.resize(fresh.points.size(), part);
    } else if (const PartLine line = line_of(region.parts[part], time); line.round()) {
      add_chords(fresh, line, a, b, part, size);
    } else {
      add_straight(fresh, a, b, part, size);
    }
  }
  return fresh;
}

Outline with_contacts_on_walls(Outline outline, const Region& region, double time) {
  for (std::size_t i = 0; i < outline.points.size(); ++i)
    if (const int part = wall_of_contact(outline, i); part != Outline::free) {
      const PartLine line = line_of(region.parts[part], time);
      const double s = line.nearest(outline.points[i]);
      outline.points[i] = line.at(std::clamp(s, 0.0, line.length));
    }
  return outline;
}

Outline with_area(const Outline& outline, const Region& region, double time, double target) {
  const auto ways = ways_outward(outline, region, time);
  double front = 0;
  for (std::size_t i = 0; i < ways.size(); ++i)
    if (outline.part[i] == Outline::free)
      front += length(outline.points[(i + 1) % ways.size()] - outline.points[i]);
  const auto bounds = bounds_of_contacts(outline, ways);
  Outline moved = outline;
  double step = 0;
  for (int trials = 0; trials < 50 && front > 0; ++trials) {
    const double miss = target - area(moved);
    if (std::abs(miss) <= 1e-14 * target) return moved;
    step += miss / front;
    for (std::size_t i = 0; i < ways.size(); ++i)
      moved.points[i] = outline.points[i] + std::clamp(step, -bounds[i], bounds[i]) * ways[i];
    moved = with_contacts_on_walls(moved, region, time);
  }
  if (front > 0 && std::abs(target - area(moved)) <= 1e-12 * target) return moved;
  throw NotConvergedError(
      fmt::format("the free surface cannot be moved so that the area of the material is {:g} "
                  "instead of {:g}",
                  target, area(outline)));
}

double area(const Outline& outline) {
  double sum = 0;
  const auto& p = outline.points;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) sum += 0.5 * cross(p[i] - p[0], p[i + 1] - p[0]);
  return sum;
}
double area(std::span<const Outline> outlines) {
  double sum = 0;
  for (const Outline& outline : outlines) sum += area(outline);
  return sum;
}

std::optional<Crossing> crossing_of(const Outline& outline) {
  const auto& p = outline.points;
  const std::size_t n = p.size();
  const auto at = [&](std::size_t i) { return p[i % n]; };
  std::vector<std::size_t> by_x(n);
  std::iota(by_x.begin(), by_x.end(), 0);
  const auto least = [&](std::size_t i) { return std::min(at(i).x, at(i + 1).x); };
  std::ranges::stable_sort(by_x, {}, least);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = by_x[k];
    const Vec2 side = at(i + 1) - at(i), next = at(i + 2) - at(i + 1);
    if (!(dot(side, side) > 0) || (cross(side, next) == 0 && dot(side, next) < 0))
      return Crossing{i, (i + 1) % n};
    for (std::size_t l = k + 1; l < n && least(by_x[l]) <= std::max(at(i).x, at(i + 1).x); ++l) {
      const std::size_t j = by_x[l];
      if ((i + 1) % n != j && (j + 1) % n != i && sides_meet(at(i), at(i + 1), at(j), at(j + 1)))
        return Crossing{i, j};
    }
  }
  return {};
}

bool meet(const Outline& one, const Outline& other) {
  const std::size_t n = one.points.size(), m = other.points.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < m; ++j)
      if (sides_meet(one.points[i], one.points[(i + 1) % n], other.points[j], other.points[(j + 1) % m]))
        return true;
  return false;
}

}  // namespace drumlin::continuum
