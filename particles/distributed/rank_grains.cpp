#include "particles/distributed/rank_grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "coupling/common/errors.hpp"

namespace drumlin::particles {
namespace {

// A forest is weighed again after so many steps, if a rank has so much more than its share.
constexpr std::int64_t steps_between = 200;
constexpr double most_share = 1.1;

}  // namespace

Reach RankGrains::reach_of(const RankState& state, const WallStep& walls, double time_step,
                           Point gain) const {
  constexpr double none = -1e300;
  std::array<double, 5> extremes{none, none, none, none, 0};  // of v_x, -v_x, v_z, -v_z, and the speed
  for (const RankGrain& g : state.grains) {
    const double v_x = g.v_x + gain.x, v_z = g.v_z + gain.z;
    extremes[0] = std::max(extremes[0], v_x), extremes[1] = std::max(extremes[1], -v_x);
    extremes[2] = std::max(extremes[2], v_z), extremes[3] = std::max(extremes[3], -v_z);
    extremes[4] = std::max(extremes[4], std::hypot(v_x, v_z));
  }
  ranks_.largest(extremes);
  double wall = 0;
  for (std::size_t s = 0; s < walls.before.size(); ++s)
    wall = std::max(wall, largest_move(walls.before[s], walls.displacement[s]) / time_step);
  const double among = std::hypot(extremes[0] + extremes[1], extremes[2] + extremes[3]);
  const double approach = std::max(among, extremes[4] + wall);
  return {domain_.largest, margin_, 2 * time_step * approach, time_step * (extremes[4] + wall)};
}

void RankGrains::refuse(const GrainOutside& outside) const {
  if (outside.id < 0) return;
  throw NotConvergedError(fmt::format(
      "grain {} is lost: it left the domain of the ranks (x from {:.6g} d to {:.6g} d, z from {:.6g} d to "
      "{:.6g} d), or jumped over a whole cell of {:.3g} d within a step; it is at x = {:.6g} d, z = {:.6g} d",
      outside.id, domain_.low.x, domain_.low.x + forest_->tiles().grid.edge(), domain_.low.z,
      domain_.low.z + forest_->tiles().grid.edge(), forest_->tiles().grid.cell, outside.x, outside.z));
}

void RankGrains::build(RankState& state, const TileGrid& grid) {
  constexpr std::int64_t of_a_grain = 10;
  std::vector<std::int64_t> weights(grid.count(), 0);
  for (const RankGrain& g : state.grains) weights[grid.tile_at({g.x, g.z})] += of_a_grain;
  ranks_.add(weights);
  for (std::int64_t& weight : weights) ++weight;
  forest_.reset();
  forest_ = std::make_unique<Forest>(ranks_, grid, weights);
  ++forests_;
  steps_ = 0;
  refuse(forest_->place(state.grains));
}

bool RankGrains::unbalanced() const {
  if (ranks_.count() == 1 || steps_ < steps_between || steps_ % steps_between != 0) return false;
  std::array<double, 1> most{static_cast<double>(forest_->owned().size())};
  ranks_.largest(most);
  return most[0] * ranks_.count() > most_share * static_cast<double>(domain_.grains);
}

void RankGrains::settle(RankState& state, const WallStep& walls, double time_step, Point gain) {
  const TileGrid grid = tile_grid(domain_.low, domain_.edge, reach_of(state, walls, time_step, gain));
  if (!forest_ || !(forest_->tiles().grid == grid) || unbalanced())
    build(state, grid);
  else
    refuse(forest_->move(state.grains));
  ++steps_;
  state.grains = forest_->owned();
  see(state);
  bring_memory(state);
}

bool RankGrains::settle_again(RankState& state, const WallStep& walls, double time_step, Point gain) {
  const Reach reach = reach_of(state, walls, time_step, gain);
  if (least_cell(reach) <= forest_->tiles().grid.cell) return false;
  build(state, tile_grid(domain_.low, domain_.edge, reach));
  state.grains = forest_->owned();
  see(state);
  bring_memory(state);
  return true;
}

void RankGrains::see(const RankState& state) {
  const auto own = static_cast<std::int32_t>(state.grains.size());
  const auto& ghosts = forest_->ghosts();
  std::vector<std::pair<std::int64_t, std::int32_t>>
      order;  // identity, place among the own and then the ghosts
  order.reserve(own + ghosts.size());
  for (const RankGrain& grain : state.grains)
    order.push_back({grain.id, static_cast<std::int32_t>(order.size())});
  for (const GhostRecord& ghost : ghosts)
    order.push_back({ghost.grain.id, static_cast<std::int32_t>(order.size())});
  std::sort(order.begin(), order.end());
  const std::int32_t rank = ranks_.rank();
  Bodies& bodies = seen_.bodies;
  for (auto* values :
       {&bodies.x, &bodies.z, &bodies.v_x, &bodies.v_z, &bodies.radius, &bodies.inverse_mass, &bodies.spin})
    values->clear();
  bodies.id.clear(), seen_.owner.clear(), seen_.place.clear();
  if (place_of_.empty()) place_of_.assign(domain_.grains, -1);
  std::fill(place_of_.begin(), place_of_.end(), -1);
  for (const auto& [id, place] : order) {
    const bool mine = place < own;
    const RankGrain& grain = mine ? state.grains[place] : ghosts[place - own].grain;
    place_of_[grain.id] = static_cast<std::int32_t>(bodies.id.size());
    bodies.x.push_back(grain.x), bodies.z.push_back(grain.z);
    bodies.v_x.push_back(grain.v_x), bodies.v_z.push_back(grain.v_z);
    bodies.radius.push_back(grain.radius), bodies.inverse_mass.push_back(grain.inverse_mass);
    if (with_spin_) bodies.spin.push_back(grain.spin);
    bodies.id.push_back(id), seen_.owner.push_back(mine ? rank : ghosts[place - own].owner);
    seen_.place.push_back(mine ? place : -1);
  }
}

/// The place of a remembered pair is where the pair stands now: its tile's owner looks for it.
void RankGrains::bring_memory(RankState& state) {
  std::vector<std::vector<RememberedContact>> to_rank(ranks_.count());
  for (const RememberedContact& contact : state.memory)
    to_rank[forest_->tiles().owner_at({contact.x, contact.z})].push_back(contact);
  state.memory.clear();
  for (const auto& of_rank : ranks_.exchange(to_rank))
    state.memory.insert(state.memory.end(), of_rank.begin(), of_rank.end());
  memory_.i.clear(), memory_.j.clear(), memory_.impulse.clear();
  memory_.time_step = state.memory_time_step;
  for (const RememberedContact& contact : state.memory) {
    const std::int32_t i = place_of_[contact.i];
    const std::int32_t j = contact.j < 0 ? static_cast<std::int32_t>(contact.j) : place_of_[contact.j];
    if (i < 0 || (contact.j >= 0 && j < 0)) continue;  // they are too far apart to meet
    memory_.i.push_back(i), memory_.j.push_back(j);
    memory_.impulse.insert(memory_.impulse.end(), contact.impulse.begin(),
                           contact.impulse.begin() + unknowns_);
  }
}

}  // namespace drumlin::particles
