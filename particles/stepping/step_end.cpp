#include "particles/stepping/step_end.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin::particles {

void find_flights(const StepEnd& end, std::span<const Candidate> pairs, const PairBodies& bodies,
                  std::vector<char>& flies) {
  const std::size_t grains = end.step.bodies.count();
  flies.resize(grains);
  for (std::size_t b = 0; b < grains; ++b) flies[b] = !end.is_pushed(b);
  if (end.changes.empty()) return;
  std::vector<std::size_t> of_flying;
  for (std::size_t a = 0; a < pairs.size(); ++a)
    if (bodies.j[a] < bodies.fixed && (flies[bodies.i[a]] | flies[bodies.j[a]]) != 0) of_flying.push_back(a);
  for (bool again = true; again;) {
    again = false;
    for (const std::size_t a : of_flying) {
      const Candidate& pair = pairs[a];
      if (flies[pair.i] == flies[pair.j]) continue;
      const Point d = end.displacement(pair.i, flies[pair.i]) - end.displacement(pair.j, flies[pair.j]) -
                      end.step.time_step * wall_velocity(pair);
      if (pair.gap + normal_part(pair, d) >= 0) continue;
      flies[pair.i] = flies[pair.j] = 0;
      again = true;
    }
  }
}

/// A pair beyond the search has a gap of at least margin + 2 h a + (bound_i + bound_j) / 2, a being the speed
/// at which it approached then.
bool MissedPairs::find_thrown(const StepEnd& end, const FreeMotion& searched,
                              const ContactDetection& detection) {
  const double h = end.step.time_step, margin = end.step.laws.detection_margin;
  bool any = false;
  is_thrown_.assign(end.step.bodies.count(), 0);
  for (std::size_t b = 0; b < is_thrown_.size(); ++b) {
    const double allowed = (margin + detection.displacement_bound(static_cast<std::int32_t>(b))) / 2;
    const Point beyond = end.shift(b) + end.displacement(b, false) - h * velocity(searched, b);
    is_thrown_[b] = dot(beyond, beyond) > allowed * allowed;
    any |= is_thrown_[b] != 0;
  }
  return any;
}

bool MissedPairs::find(const StepEnd& end, const FreeMotion& searched, const ContactDetection& detection,
                       std::span<const Candidate> pairs) {
  missed_.clear();
  if (!find_thrown(end, searched, detection)) return false;
  const Bodies& bodies = end.step.bodies;
  const Period& period = end.step.laws.period;
  const auto known = [&](const ListedPair& pair) {
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const Candidate& c) { return c.i == pair.i && c.j == pair.j; });
  };
  for (const ListedPair& pair : detection.listed_pairs()) {
    if (!(is_thrown_[pair.i] | is_thrown_[pair.j])) continue;
    const Point whole = position(bodies, pair.i) - position(bodies, pair.j);
    const Point d = period.nearest(whole), image = period.image_velocity(whole - d);
    const double reach = bodies.radius[pair.i] + bodies.radius[pair.j];
    Candidate found{pair.i, pair.j, 0, 0, 0, image.x, image.z};
    found.gap = normal_of(d.x, d.z, found.n_x, found.n_z) - reach;
    // Those below the margin are among the pairs; which of those beyond are listed depends on the list's age.
    if (found.gap < end.step.laws.detection_margin || found.gap >= detection.listed_within()) continue;
    const Point then = d + end.shift(pair.i) - end.shift(pair.j) + end.displacement(pair.i, false) -
                       end.displacement(pair.j, false) - end.step.time_step * image;
    if (dot(then, then) < reach * reach && !known(pair)) missed_.push_back(found);
  }
  return !missed_.empty();
}

}  // namespace drumlin::particles
