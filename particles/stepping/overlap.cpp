#include "particles/stepping/overlap.hpp"

#include <algorithm>

#include "particles/detection/contact_list.hpp"
#include "particles/stepping/wall_crossing.hpp"

namespace drumlin::particles {

double OverlapSearch::undo_crossings(std::span<const Candidate> pairs, const WallStep& walls,
                                     const Period& period, double time_step, Bodies& bodies) {
  double deepest = 0;
  for (const Candidate& pair : pairs) {
    if (pair.j >= 0) continue;
    const std::size_t s = -1 - pair.j;
    deepest =
        std::max(deepest, undo_crossing(walls.before[s], walls.after[s], period, time_step, bodies, pair.i));
  }
  return deepest;
}

Overlap OverlapSearch::find(const MovedContacts& contacts, const Bodies& bodies, const WallStep& walls,
                            const Period& period, double margin, std::optional<LostGrain>& lost) {
  const auto& pairs = contacts.pairs;
  const SweepPlan& plan = contacts.plan;
  now_.resize(pairs.size());
  loops_.each(pairs.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      now_[a] = {pairs[a].i, pairs[a].j, 0, 0, 0};
      now_[a].gap = gap_now(pairs[a], bodies, walls.after, period, now_[a].n_x, now_[a].n_z);
    }
  });
  Overlap overlap;
  double sum = 0;
  close_.clear();
  plan_ = plan;
  std::size_t group = 0;
  for (std::size_t a = 0; a < pairs.size(); ++a) {
    for (; plan.group_start[group] == static_cast<std::int32_t>(a); ++group)
      plan_.group_start[group] = static_cast<std::int32_t>(close_.size());
    const ClosePair& now = now_[a];
    if (now.j < 0 && !lost && has_left(walls.after[-1 - now.j], bodies.radius[now.i], now.gap))
      lost = LostGrain{now.i, bodies.x[now.i], bodies.z[now.i], LostGrain::How::left_container};
    if (contacts.impulses[contacts.dim * a] > 0) {
      const double depth = std::max(0.0, -now.gap);
      sum += depth;
      overlap.max = std::max(overlap.max, depth);
      ++overlap.loaded;
    }
    if (now.gap < margin) close_.push_back(now);
  }
  if (!pairs.empty()) plan_.group_start.back() = static_cast<std::int32_t>(close_.size());
  if (overlap.loaded > 0) overlap.mean = sum / overlap.loaded;
  return overlap;
}

}  // namespace drumlin::particles
