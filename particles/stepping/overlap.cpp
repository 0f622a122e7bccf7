#include "particles/stepping/overlap.hpp"

#include <algorithm>

#include "particles/detection/contact_list.hpp"
#include "particles/stepping/lost_at_wall.hpp"

namespace drumlin::particles {
Overlap OverlapSearch::find(const MovedContacts& contacts, const Bodies& bodies, const WallStep& walls,
                            const Period& period, double margin, std::optional<LostGrain>& lost) {
  const auto& pairs = contacts.pairs;
  const SweepPlan& plan = contacts.plan;
  pairs_.renew(pairs.size());
  loops_.each(pairs.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      pairs_[a] = {pairs[a].i, pairs[a].j, 0, 0, 0};
      pairs_[a].gap = gap_now(pairs[a], bodies, walls.after, period, pairs_[a].n_x, pairs_[a].n_z);
    }
  });
  Overlap overlap;
  double sum = 0;
  plan_ = plan;
  std::size_t close = 0;
  std::size_t group = 0;
  for (std::size_t a = 0; a < pairs.size(); ++a) {
    for (; plan.group_start[group] == static_cast<std::int32_t>(a); ++group)
      plan_.group_start[group] = static_cast<std::int32_t>(close);
    const ClosePair now = pairs_[a];
    const bool loaded = contacts.impulses[contacts.dim * a] > 0;
    if (now.j < 0 && !lost) lost = lost_at_wall(now, loaded, bodies, walls, period);
    if (loaded) {
      const double depth = std::max(0.0, -now.gap);
      sum += depth;
      overlap.max = std::max(overlap.max, depth);
      ++overlap.loaded;
    }
    if (now.gap < margin) pairs_[close++] = now;
  }
  pairs_.resize(close);
  if (!pairs.empty()) plan_.group_start.back() = static_cast<std::int32_t>(close);
  if (overlap.loaded > 0) overlap.mean = sum / overlap.loaded;
  return overlap;
}

}  // namespace drumlin::particles
