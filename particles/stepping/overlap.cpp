#include "particles/stepping/overlap.hpp"

#include <algorithm>

#include "particles/detection/contact_list.hpp"
#include "particles/stepping/lost_at_wall.hpp"

namespace drumlin::particles {

Overlap OverlapSearch::find(const MovedContacts& contacts, const Bodies& bodies, const WallStep& walls,
                            const Period& period, double margin, std::optional<LostGrain>& lost) {
  constexpr std::size_t piece = ClosePairs::piece;
  const auto& pairs = contacts.pairs;
  const std::size_t pieces = (pairs.size() + piece - 1) / piece;
  plan_ = contacts.plan;
  pairs_.resize_uninitialized(pairs.size());
  sums_.assign(pieces, {});
  loops_.each_of(static_cast<int>(pieces), [&](int p) {
    const std::size_t begin = p * piece, end = std::min(pairs.size(), begin + piece);
    sums_[p] = overlaps_among(begin, end, contacts, bodies, walls, period, margin);
  });
  Overlap overlap;
  double sum = 0;
  overlap_ = false;
  earlier_.assign(1, 0);
  for (const OverlapSums& more : sums_) {
    sum += more.depths;
    if (more.deepest > overlap.max) {
      overlap.max = more.deepest;
      overlap.grain = more.i, overlap.other = more.j;
    }
    overlap.loaded += more.loaded;
    overlap_ |= more.overlap;
    earlier_.push_back(earlier_.back() + more.close);
    if (!lost) lost = more.lost;
  }
  if (!pairs.empty())
    for (std::size_t g = 0; g < plan_.group_start.size(); ++g) {
      const std::size_t first = contacts.plan.group_start[g];
      plan_.group_start[g] =
          first < pairs.size() ? plan_.group_start[g] + earlier_[first / piece] : earlier_.back();
    }
  if (const std::int64_t i = overlap.grain, j = overlap.other; i >= 0) {
    overlap.x = bodies.x[i], overlap.z = bodies.z[i];
    if (!bodies.id.empty()) overlap.grain = bodies.id[i], overlap.other = j < 0 ? j : bodies.id[j];
  }
  if (overlap.loaded > 0) overlap.mean = sum / static_cast<double>(overlap.loaded);
  return overlap;
}

OverlapSums OverlapSearch::overlaps_among(std::size_t begin, std::size_t end, const MovedContacts& contacts,
                                          const Bodies& bodies, const WallStep& walls, const Period& period,
                                          double margin) {
  OverlapSums sums;
  const std::vector<std::int32_t>& starts = contacts.plan.group_start;
  std::size_t group =
      std::lower_bound(starts.begin(), starts.end(), static_cast<std::int32_t>(begin)) - starts.begin();
  ClosePair* close = &pairs_[begin];
  const double *const x = bodies.x.data(), *const z = bodies.z.data(), *const radius = bodies.radius.data();
  const auto [of_i, of_j, fixed] = contacts.bodies;
  const double* const impulses = contacts.impulses.data();
  const Period domain = period;
  for (std::size_t a = begin; a < end; ++a) {
    for (; starts[group] == static_cast<std::int32_t>(a); ++group)
      plan_.group_start[group] = static_cast<std::int32_t>(close - &pairs_[begin]);
    ClosePair now{of_i[a], of_j[a], 0, 0, 0};
    const bool loaded = impulses[contacts.dim * a] > 0;
    if (now.j >= fixed) {
      now.j = contacts.pairs[a].j;
      now.gap = gap_now(contacts.pairs[a], bodies, walls.after, period, now.n_x, now.n_z);
      if (!sums.lost) sums.lost = lost_at_wall(now, loaded, bodies, walls, period);
    } else {
      const Point d = domain.nearest(Point{x[now.i] - x[now.j], z[now.i] - z[now.j]});
      now.gap = normal_of(d.x, d.z, now.n_x, now.n_z) - radius[now.i] - radius[now.j];
    }
    const double depth = loaded * std::max(0.0, -now.gap);  // without a branch
    sums.depths += depth;
    if (depth > sums.deepest) sums.deepest = depth, sums.i = now.i, sums.j = now.j;
    sums.loaded += loaded;
    *close = now;
    close += now.gap < margin;
    sums.overlap |= now.gap < 0;
  }
  sums.close = static_cast<std::int32_t>(close - &pairs_[begin]);
  return sums;
}

}  // namespace drumlin::particles
