#include "particles/distributed/rank_projection.hpp"

#include <algorithm>
#include <array>

#include "particles/detection/contact_list.hpp"
#include "particles/stepping/lost_at_wall.hpp"

namespace drumlin::particles {

Overlap RankOverlap::find(const MovedTiles& contacts, const Bodies& bodies, const WallStep& walls,
                          double margin, std::optional<LostGrain>& lost) {
  pairs_.clear(), tiles_.clear();
  std::array<ExactSum, 1> sum;
  std::array<double, 2> extremes{0, 0};  // deepest of the loaded pairs, and of all
  std::int64_t loaded_pairs = 0;
  const Period open;
  for (const TileRange& tile : contacts.tiles) {
    TileRange close = tile;
    close.begin = static_cast<std::int32_t>(pairs_.size());
    double of_tile = 0;
    for (std::int32_t a = tile.begin; a < tile.end; ++a) {
      ClosePair now{contacts.pairs[a].i, contacts.pairs[a].j, 0, 0, 0};
      now.gap = gap_now(contacts.pairs[a], bodies, walls.after, open, now.n_x, now.n_z);
      const bool loaded = contacts.impulses[contacts.dim * a] > 0;
      const double depth = std::max(0.0, -now.gap);
      if (now.j < 0 && !lost) lost = lost_at_wall(now, loaded, bodies, walls, open);
      if (loaded) of_tile += depth, extremes[0] = std::max(extremes[0], depth), ++loaded_pairs;
      extremes[1] = std::max(extremes[1], depth);
      if (now.gap < margin) pairs_.push_back(now);
    }
    sum[0].add(of_tile);
    close.end = static_cast<std::int32_t>(pairs_.size());
    tiles_.push_back(close);
  }
  loaded_pairs = ranks_.add(sum, loaded_pairs);
  ranks_.largest(extremes);
  Overlap overlap;
  overlap.loaded = loaded_pairs;
  overlap.max = extremes[0];
  if (overlap.loaded > 0) overlap.mean = sum[0].value() / static_cast<double>(overlap.loaded);
  any_ = extremes[1] > 0;
  return overlap;
}

int RankProjection::apply(const RankOverlap& overlap, const TileOrder& order,
                          std::span<const char> counts_here, Halo& halo, const ProjectionRule& projection,
                          Bodies& bodies) {
  if (!overlap.any()) return 0;
  const auto pairs = overlap.close();
  auto& W = problem_.W;
  W.inverse_mass.assign(bodies.inverse_mass.begin(), bodies.inverse_mass.end());
  W.inverse_mass.push_back(0);
  W.resize(pairs.size());
  problem_.q.resize(pairs.size());
  for (std::size_t a = 0; a < pairs.size(); ++a) {
    const ClosePair& pair = pairs[a];
    W.set(static_cast<int>(a), pair.i, pair.j < 0 ? W.fixed() : pair.j, pair.n_x, pair.n_z);
    problem_.q[a] = projection.wanted_gap(pair.gap);
  }
  solution_.impulses.assign(pairs.size(), 0.0);
  StoppingRule rule;
  rule.tolerance = projection_tolerance;
  rule.max_sweeps = projection.sweeps;
  // What is left is seen, and reported, as the overlap of the next step.
  const SolveReport report = solver_.solve(problem_, {overlap.tiles(), order, counts_here, {}, {}}, halo,
                                           rule, TileMethod::accelerated, solution_);
  const auto& moved = solution_.velocities.bodies;
  for (std::size_t b = 0; b < bodies.count(); ++b) bodies.x[b] += moved[b].x, bodies.z[b] += moved[b].z;
  return report.sweeps;
}

}  // namespace drumlin::particles
