#include "particles/distributed/rank_grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "coupling/common/errors.hpp"
#include "particles/parallel/work_memory.hpp"

namespace drumlin::particles {
namespace {

// A forest is weighed again after so many steps, if a rank has so much more than its share.
constexpr std::int64_t steps_between = 200;
constexpr double most_share = 1.1;
// One that was made before any contact was known, as at the start from another run, is weighed again soon.
constexpr std::int64_t steps_without_contacts = 3;
constexpr double most_share_without_contacts = 1.01;
// Cells change back and forth with the fastest grain: so many forests of other cells wait for that.
constexpr std::size_t most_earlier = 2;
// Of that work: sweeps are that of contacts, most else that of grains.
constexpr std::int64_t of_a_grain = 10, of_a_loaded_contact = 10;

}  // namespace

RankGrains::Need RankGrains::need_of(const RankState& state, const WallStep& walls, double time_step,
                                     Point gain) const {
  Extremes extremes;
  const bool sorted = now_.forest != nullptr;  // since then the grains stand as they were sorted
  for (std::size_t k = 0; k < state.grains.size(); ++k) {
    const RankGrain& g = state.grains[k];
    extremes.add(g.v_x + gain.x, g.v_z + gain.z);
    if (!sorted) continue;
    const double x = g.x - sorted_at_[k].x, z = g.z - sorted_at_[k].z;
    extremes.raise(5, x * x + z * z);
    if (!now_.forest->tiles().grid.contains({g.x, g.z})) extremes.raise(6, 1);
  }
  ranks_.largest(extremes.numbers);
  return {reach_of(extremes, walls, time_step), std::sqrt(extremes.numbers[5]), extremes.numbers[6] > 0};
}

Reach RankGrains::reach_again(const WallStep& walls, double time_step, Point gain) const {
  Extremes extremes;
  const Bodies& bodies = seen_.bodies;
  for (std::size_t b = 0; b < bodies.count(); ++b)
    extremes.add(bodies.v_x[b] + gain.x, bodies.v_z[b] + gain.z);
  ranks_.largest(extremes.numbers);
  return reach_of(extremes, walls, time_step);
}

Reach RankGrains::reach_of(const Extremes& extremes, const WallStep& walls, double time_step) const {
  const double speed = std::sqrt(extremes.numbers[4]);
  double wall = 0;
  for (std::size_t s = 0; s < walls.before.size(); ++s)
    wall = std::max(wall, largest_move(walls.before[s], walls.displacement[s]) / time_step);
  const auto& n = extremes.numbers;
  const double among = std::hypot(n[0] + n[1], n[2] + n[3]);
  const double approach = std::max(among, speed + wall);
  return {domain_.largest, margin_, 2 * time_step * approach, time_step * (speed + wall)};
}

bool RankGrains::still_sorted() const { return drift_ <= most_drift(reach_, now_.forest->tiles().grid.cell); }

void RankGrains::refuse(const GrainOutside& outside) const {
  if (outside.id < 0) return;
  const TileGrid& grid = now_.forest->tiles().grid;
  const std::string jumped =
      ranks_.count() == 1 ? ""
                          : fmt::format(", or jumped over a whole cell of {:.3g} d within a step", grid.cell);
  throw NotConvergedError(fmt::format(
      "grain {} is lost: it left the domain of the ranks (x from {:.6g} d to {:.6g} d, z from {:.6g} d to "
      "{:.6g} d){}; it is at x = {:.6g} d, z = {:.6g} d",
      outside.id, domain_.low.x, domain_.low.x + grid.edge(), domain_.low.z, domain_.low.z + grid.edge(),
      jumped, outside.x, outside.z));
}

/// Makes a forest for a grid, by the weights of now.
void RankGrains::build(RankState& state, const TileGrid& grid) {
  std::vector<std::int64_t> weights(grid.count(), 0);
  if (ranks_.count() > 1) {
    for (const RankGrain& g : state.grains) weights[grid.tile_at({g.x, g.z})] += of_a_grain;
    for (const RememberedContact& c : state.memory) weights[grid.tile_at({c.x, c.z})] += of_a_loaded_contact;
    ranks_.add(weights);
  }
  for (std::int64_t& weight : weights) ++weight;
  now_ = {};
  now_ = {std::make_unique<Forest>(ranks_, grid, weights), ranks_.any(!state.memory.empty()), 0};
  ++forests_;
  refuse(now_.forest->place(state.grains));
}

/// The same with a forest that was made for this grid before, if there is one.
void RankGrains::change_forest(RankState& state, const TileGrid& grid) {
  const auto found = std::find_if(earlier_.begin(), earlier_.end(),
                                  [&](const Made& made) { return made.forest->tiles().grid == grid; });
  Made next;
  if (found != earlier_.end()) {
    next = std::move(*found);
    earlier_.erase(found);
  }
  if (now_.forest) {
    now_.forest->clear();
    earlier_.insert(earlier_.begin(), std::move(now_));
    if (earlier_.size() > most_earlier) earlier_.pop_back();
  }
  if (!next.forest) return build(state, grid);
  now_ = std::move(next);
  refuse(now_.forest->place(state.grains));
}

bool RankGrains::unbalanced(const RankState& state) const {
  const bool soon = !now_.knows_contacts && now_.steps == steps_without_contacts;
  if (ranks_.count() == 1 || (!soon && (now_.steps < steps_between || now_.steps % steps_between != 0)))
    return false;
  if (soon && !ranks_.any(!state.memory.empty())) return false;
  std::array<std::int64_t, 1> all{of_a_grain * static_cast<std::int64_t>(state.grains.size()) +
                                  of_a_loaded_contact * static_cast<std::int64_t>(state.memory.size())};
  std::array<double, 1> most{static_cast<double>(all[0])};
  ranks_.largest(most);
  ranks_.add(all);
  return most[0] * ranks_.count() >
         (soon ? most_share_without_contacts : most_share) * static_cast<double>(all[0]);
}

void RankGrains::sort(RankState& state) { refuse(now_.forest->move(state.grains)); }

void RankGrains::settle(RankState& state, const WallStep& walls, double time_step, Point gain) {
  const Need need = need_of(state, walls, time_step, gain);
  drift_ = need.drift;
  reach_ = need.reach;
  const TileGrid grid = tile_grid(domain_.low, domain_.edge, need.reach, domain_.grains);
  const bool other_grid = !now_.forest || !(now_.forest->tiles().grid == grid);
  const bool uneven = !other_grid && unbalanced(state);
  ++now_.steps;
  if (!other_grid && !uneven && !need.outside && still_sorted()) {
    follow(state);
    bring_memory(state);
    return;
  }
  if (other_grid) {
    change_forest(state, grid);
  } else if (uneven) {
    earlier_.clear();  // their shares are no more even
    build(state, grid);
  } else {
    sort(state);
  }
  take_sorted(state);
}

bool RankGrains::settle_again(RankState& state, const WallStep& walls, double time_step, Point gain) {
  reach_ = reach_again(walls, time_step, gain);
  const bool fits = least_cell(reach_) <= now_.forest->tiles().grid.needed_cell();
  if (fits && still_sorted()) return false;
  if (fits)
    sort(state);
  else
    change_forest(state, tile_grid(domain_.low, domain_.edge, reach_, domain_.grains));
  take_sorted(state);
  return true;
}

void RankGrains::take_sorted(RankState& state) {
  ++sorts_;
  drift_ = 0;
  state.grains = now_.forest->take_owned();
  sorted_at_.clear();
  for (const RankGrain& grain : state.grains) sorted_at_.push_back({grain.x, grain.z});
  see(state);
  agree_on_ghosts();
  bring_memory(state);
}

/// Seen grains stand in the order of their identities.
void RankGrains::see(const RankState& state) {
  const auto own = static_cast<std::int32_t>(state.grains.size());
  const auto& ghosts = now_.forest->ghosts();
  const std::size_t count = own + ghosts.size();
  place_of_.assign(domain_.grains, -1);
  for (std::int32_t k = 0; k < own; ++k) place_of_[state.grains[k].id] = k;
  for (std::size_t k = 0; k < ghosts.size(); ++k)
    place_of_[ghosts[k].grain.id] = own + static_cast<std::int32_t>(k);
  const std::int32_t rank = ranks_.rank();
  Bodies& bodies = seen_.bodies;
  for (auto* values : {&bodies.x, &bodies.z, &bodies.v_x, &bodies.v_z, &bodies.radius, &bodies.inverse_mass})
    resize_closely(*values, count);
  if (with_spin_) resize_closely(bodies.spin, count);
  resize_closely(bodies.id, count), resize_closely(seen_.owner, count), resize_closely(seen_.place, count);
  std::int32_t b = 0;
  for (std::int32_t& place_of_id : place_of_) {
    const std::int32_t place = place_of_id;  // among the own and then the ghosts
    if (place < 0) continue;
    const bool mine = place < own;
    const RankGrain& grain = mine ? state.grains[place] : ghosts[place - own].grain;
    bodies.x[b] = grain.x, bodies.z[b] = grain.z;
    bodies.v_x[b] = grain.v_x, bodies.v_z[b] = grain.v_z;
    bodies.radius[b] = grain.radius, bodies.inverse_mass[b] = grain.inverse_mass;
    if (with_spin_) bodies.spin[b] = grain.spin;
    bodies.id[b] = grain.id, seen_.owner[b] = mine ? rank : ghosts[place - own].owner;
    seen_.place[b] = mine ? place : -1;
    place_of_id = b++;
  }
}

/// Tells the owners of ghosts which of their grains this rank sees.
void RankGrains::agree_on_ghosts() {
  const auto ranks = static_cast<std::size_t>(ranks_.count());
  std::vector<std::vector<std::int64_t>> wanted(ranks);
  ghosts_of_.assign(ranks, {}), shown_to_.assign(ranks, {}), to_show_.assign(ranks, {});
  for (std::size_t b = 0; b < seen_.owner.size(); ++b) {
    if (seen_.place[b] >= 0) continue;
    wanted[seen_.owner[b]].push_back(seen_.bodies.id[b]);
    ghosts_of_[seen_.owner[b]].push_back(static_cast<std::int32_t>(b));
  }
  if (ranks == 1) return;
  const auto asked = ranks_.exchange(wanted);
  for (std::size_t r = 0; r < ranks; ++r)
    for (const std::int64_t id : asked[r]) shown_to_[r].push_back(seen_.place[place_of_[id]]);
}

/// Seen grains as they are now.
void RankGrains::follow(const RankState& state) {
  Bodies& bodies = seen_.bodies;
  const auto set = [&](std::size_t b, const auto& grain) {
    bodies.x[b] = grain.x, bodies.z[b] = grain.z;
    bodies.v_x[b] = grain.v_x, bodies.v_z[b] = grain.v_z;
    if (with_spin_) bodies.spin[b] = grain.spin;
  };
  for (std::size_t b = 0; b < seen_.place.size(); ++b)
    if (seen_.place[b] >= 0) set(b, state.grains[seen_.place[b]]);
  if (ranks_.count() == 1) return;
  for (std::size_t r = 0; r < shown_to_.size(); ++r) {
    to_show_[r].clear();
    for (const std::int32_t place : shown_to_[r]) {
      const RankGrain& grain = state.grains[place];
      to_show_[r].push_back({grain.x, grain.z, grain.v_x, grain.v_z, grain.spin});
    }
  }
  const auto shown = ranks_.exchange(to_show_);
  for (std::size_t r = 0; r < shown.size(); ++r)
    for (std::size_t k = 0; k < shown[r].size(); ++k) set(ghosts_of_[r][k], shown[r][k]);
}

/// The place of a remembered pair is where the pair stands now: its tile's owner looks for it. Returns how
/// many contacts stay here; those that come stand behind them, in order.
std::size_t RankGrains::pass_memory_on(std::vector<RememberedContact>& memory) const {
  if (ranks_.count() == 1) return memory.size();
  const auto rank = static_cast<std::size_t>(ranks_.rank());
  std::vector<std::vector<RememberedContact>> to_rank(ranks_.count());
  std::erase_if(memory, [&](const RememberedContact& contact) {
    const auto owner = static_cast<std::size_t>(now_.forest->tiles().owner_at({contact.x, contact.z}));
    if (owner != rank) to_rank[owner].push_back(contact);
    return owner != rank;
  });
  const std::size_t stay = memory.size();
  for (const auto& of_rank : ranks_.exchange(to_rank))
    memory.insert(memory.end(), of_rank.begin(), of_rank.end());
  std::sort(memory.begin() + static_cast<std::ptrdiff_t>(stay), memory.end(), comes_before);
  return stay;
}

void RankGrains::bring_memory(RankState& state) {
  const std::size_t stay = pass_memory_on(state.memory), most = state.memory.size();
  resize_closely(memory_.i, most), resize_closely(memory_.j, most);
  resize_closely(memory_.impulse, unknowns_ * most);
  memory_.time_step = state.memory_time_step;
  std::size_t kept = 0;
  const auto keep = [&](const RememberedContact& contact) {
    const std::int32_t i = place_of_[contact.i];
    const std::int32_t j = contact.j < 0 ? static_cast<std::int32_t>(contact.j) : place_of_[contact.j];
    if (i < 0 || (contact.j >= 0 && j < 0)) return;  // they are too far apart to meet
    memory_.i[kept] = i, memory_.j[kept] = j;
    for (int c = 0; c < unknowns_; ++c) memory_.impulse[unknowns_ * kept + c] = contact.impulse[c];
    ++kept;
  };
  // Both parts are in order, but for what a run begins with, and where grains are settled again.
  std::size_t come = stay;
  for (std::size_t k = 0; k < stay; ++k) {
    while (come < most && comes_before(state.memory[come], state.memory[k])) keep(state.memory[come++]);
    keep(state.memory[k]);
  }
  while (come < most) keep(state.memory[come++]);
  memory_.i.resize(kept), memory_.j.resize(kept), memory_.impulse.resize(unknowns_ * kept);
  put_in_order(memory_);
}

}  // namespace drumlin::particles
