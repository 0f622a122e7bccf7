#include "particles/distributed/rank_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "particles/distributed/exact_sum.hpp"
#include "particles/distributed/step_pairs.hpp"
#include "particles/scene/placement.hpp"
#include "particles/scene/scene_walls.hpp"
#include "particles/scene/thermal.hpp"
#include "particles/stepping/scene_solver.hpp"
#include "particles/stepping/snapshot_of_state.hpp"
#include "particles/stepping/standing_start.hpp"

namespace drumlin::particles {
namespace {

/// A square around all that a scene names.
Domain domain_of(const Scene& scene, const Scales& scales, const Walls& walls, const Bodies& bodies) {
  constexpr double room = 2;  // d, on each side
  Extent extent = extent_of(scene, scales, walls);
  for (std::size_t b = 0; b < bodies.count(); ++b) extent.add(bodies.x[b], bodies.z[b], bodies.radius[b]);
  Domain domain;
  domain.edge = std::max(extent.x_high - extent.x_low, extent.z_high - extent.z_low) + 2 * room;
  domain.low = {(extent.x_low + extent.x_high - domain.edge) / 2, extent.z_low - room};
  domain.grains = static_cast<std::int64_t>(bodies.count());
  for (const double radius : bodies.radius) domain.largest = std::max(domain.largest, 2 * radius);
  return domain;
}

}  // namespace

RankSimulation::RankSimulation(const Scene& scene, const Ranks& ranks, int threads)
    : scene_(scene),
      ranks_(ranks),
      scales_(scales_of(scene)),
      plan_(time_plan(scene, scales_)),
      walls_(walls_of(scene, scales_)) {
  Bodies all = place_grains(scene, scales_);
  if (scene.grains.thermal_speed_mm_s)
    add_thermal_motion(*scene.grains.thermal_speed_mm_s * 1e-3 / scales_.velocity_m_s(), scene.seed, all);
  enter_stage(0);
  make_stepper(threads, all);
  take_own(all);
  const StepLaws laws = laws_of(scene, scales_);
  if (!starts_deposited(scene) || !laws.gravity) return;
  own_.memory_time_step = plan_.stages[0].time_step;
  if (ranks_.rank() == 0)
    take_memory(impulses_under_weight(all, walls_.shapes_at(0, state_.driven), laws.period, *laws.gravity,
                                      own_.memory_time_step, scene.effects.friction ? 2 : 1),
                all);
}

RankSimulation::RankSimulation(const Scene& scene, SimulationState state, const Ranks& ranks, int threads)
    : scene_(scene),
      ranks_(ranks),
      scales_(scales_of(scene)),
      plan_(time_plan(scene, scales_)),
      walls_(walls_of(scene, scales_)),
      state_(std::move(state)) {
  for (int before = 0; before < state_.stage; ++before) open_walls(walls_, scene_.stages[before]);
  walls_.pose_at_start = state_.pose_at_start;
  (void)begin_stage(walls_, scene_.stages[state_.stage], scales_, 0);
  walls_.pose_at_start = state_.pose_at_start;
  const Bodies all = std::move(state_.bodies);
  make_stepper(threads, all);
  take_own(all);
  if (ranks_.rank() == 0) take_memory(state_.memory, all);
  own_.memory_time_step = state_.memory.time_step;
  state_.bodies = {}, state_.memory = {};
  if (ranks_.rank() != 0) state_.marks.clear();
}

void RankSimulation::make_stepper(int threads, const Bodies& all) {
  grains_ = static_cast<std::int64_t>(all.count());
  // The walls of the scene where it begins: a run that is continued has the same domain.
  const Walls first = walls_of(scene_, scales_);
  const Domain domain =
      domain_of(scene_, scales_, first, state_.step == 0 ? all : place_grains(scene_, scales_));
  stepper_ = make_rank_stepper(laws_of(scene_, scales_), solver_of(scene_, threads), domain, ranks_);
}

/// Shares of about equal size; the first step sends them where they belong.
void RankSimulation::take_own(const Bodies& all) {
  const std::size_t rank = ranks_.rank(), ranks = ranks_.count();
  for (std::size_t b = all.count() * rank / ranks; b < all.count() * (rank + 1) / ranks; ++b)
    own_.grains.push_back({static_cast<std::int64_t>(b), all.x[b], all.z[b], all.v_x[b], all.v_z[b],
                           all.spin.empty() ? 0 : all.spin[b], all.radius[b], all.inverse_mass[b]});
}

/// Of the first rank, which has it brought to the owners of the tiles.
void RankSimulation::take_memory(const ContactMemory& memory, const Bodies& all) {
  const int dim = scene_.effects.friction ? 2 : 1;
  own_.memory.reserve(memory.i.size());
  for (std::size_t m = 0; m < memory.i.size(); ++m) {
    RememberedContact contact;
    contact.i = memory.i[m], contact.j = memory.j[m];
    const Point place = middle_of({memory.i[m], memory.j[m]}, all);
    contact.x = place.x, contact.z = place.z;
    for (int c = 0; c < dim; ++c) contact.impulse[c] = memory.impulse[dim * m + c];
    own_.memory.push_back(contact);
  }
}

void RankSimulation::enter_stage(int stage) {
  state_.driven = begin_stage(walls_, scene_.stages[stage], scales_, state_.time_in_stage, state_.driven);
  state_.stage = stage;
  state_.step_in_stage = 0;
  state_.time_at_stage_start += state_.time_in_stage;
  state_.time_in_stage = 0;
  state_.pose_at_start = walls_.pose_at_start;
}

/// As in a simulation on one process; the first rank keeps the places.
void RankSimulation::mark_positions() {
  if (scene_.output.velocity_window_s <= 0) return;
  const double window = scene_.output.velocity_window_s / scales_.time_s;
  const auto steps = std::max<std::int64_t>(1, std::llround(window / plan_.stages[state_.stage].time_step));
  if (!std::binary_search(plan_.snapshot_steps.begin(), plan_.snapshot_steps.end(), state_.step + steps))
    return;
  struct Place {
    std::int64_t id;
    double x, z;
  };
  std::vector<Place> own;
  own.reserve(own_.grains.size());
  for (const RankGrain& g : own_.grains) own.push_back({g.id, g.x, g.z});
  const auto places = ranks_.gather<Place>(own);
  if (ranks_.rank() != 0) return;
  std::vector<double> x(places.size()), z(places.size());
  for (const Place& place : places) x[place.id] = place.x, z[place.id] = place.z;
  state_.marks.push_back({state_.step + steps, state_.time(), std::move(x), std::move(z)});
}

StepReport RankSimulation::step() {
  if (state_.step_in_stage == plan_.stages[state_.stage].steps) enter_stage(state_.stage + 1);
  mark_positions();
  const double h = plan_.stages[state_.stage].time_step;
  WallStep walls = wall_step(walls_, state_.time_in_stage, h);
  const StepReport report = stepper_->advance(own_, walls, h);
  ++state_.step;
  ++state_.step_in_stage;
  state_.time_in_stage = static_cast<double>(state_.step_in_stage) * h;
  return report;
}

bool RankSimulation::snapshot_due() const {
  return std::binary_search(plan_.snapshot_steps.begin(), plan_.snapshot_steps.end(), state_.step);
}

/// Room for so many grains, whose spins count.
Bodies RankSimulation::empty_bodies(std::size_t grains) const {
  Bodies bodies;
  for (auto* values : {&bodies.x, &bodies.z, &bodies.v_x, &bodies.v_z, &bodies.radius, &bodies.inverse_mass})
    values->resize(grains);
  if (scene_.effects.spin) bodies.spin.resize(grains);
  return bodies;
}

/// Identities begin with `first`.
void RankSimulation::put(const RankGrain& g, std::int64_t first, Bodies& bodies) const {
  const auto b = static_cast<std::size_t>(g.id - first);
  bodies.x[b] = g.x, bodies.z[b] = g.z, bodies.v_x[b] = g.v_x, bodies.v_z[b] = g.v_z;
  bodies.radius[b] = g.radius, bodies.inverse_mass[b] = g.inverse_mass;
  if (scene_.effects.spin) bodies.spin[b] = g.spin;
}

Bodies RankSimulation::gathered_bodies() const {
  const auto grains = ranks_.gather<RankGrain>(own_.grains);
  Bodies bodies = empty_bodies(grains.size());
  for (const RankGrain& g : grains) put(g, 0, bodies);
  return bodies;
}

std::int64_t RankSimulation::first_of_part(int rank) const {
  if (!all_have_parts()) return rank == 0 ? 0 : grains_;
  return grains_ * rank / ranks_.count();
}

std::size_t RankSimulation::part_of(std::int64_t id) const {
  if (!all_have_parts()) return 0;
  return static_cast<std::size_t>(((id + 1) * ranks_.count() - 1) / grains_);
}

/// What each rank has sent to this one's part.
template <class Item, class Id>
std::vector<std::vector<Item>> RankSimulation::to_parts(std::span<const Item> items, Id id_of) const {
  if (ranks_.count() == 1) return {{items.begin(), items.end()}};
  std::vector<std::vector<Item>> to_rank(ranks_.count());
  for (const Item& item : items) to_rank[part_of(id_of(item))].push_back(item);
  return ranks_.exchange(to_rank);
}

Bodies RankSimulation::bodies_of_part() const {
  const std::int64_t first = first_of_part(ranks_.rank());
  Bodies bodies = empty_bodies(static_cast<std::size_t>(first_of_part(ranks_.rank() + 1) - first));
  for (const auto& of_rank : to_parts<RankGrain>(own_.grains, [](const RankGrain& g) { return g.id; }))
    for (const RankGrain& grain : of_rank) put(grain, first, bodies);
  return bodies;
}

std::vector<SnapshotContact> RankSimulation::contacts_of_part() {
  std::vector<SnapshotContact> all;
  const auto take = [&](const std::vector<SnapshotContact>& contacts) {
    for (const auto& of_rank : to_parts<SnapshotContact>(
             contacts, [](const SnapshotContact& contact) { return std::int64_t{contact.i}; }))
      all.insert(all.end(), of_rank.begin(), of_rank.end());
  };
  take(stepper_->loaded_contacts());
  take(stepper_->strikes());  // after all contacts: impulses of a pair are added in this order
  return one_for_each_pair(std::move(all));
}

decltype(SimulationState::marks) RankSimulation::marks_of_part() {
  auto& marks = state_.marks;
  while (!marks.empty() && marks.front().snapshot_step < state_.step) marks.pop_front();
  std::vector<double> time;
  std::vector<std::vector<double>> x(ranks_.count()), z(ranks_.count());
  if (!marks.empty() && marks.front().snapshot_step == state_.step) {
    const SimulationState::Mark mark = std::move(marks.front());
    marks.pop_front();
    time.push_back(mark.time);
    for (int r = 0; r < ranks_.count(); ++r) {
      const std::int64_t begin = first_of_part(r), end = first_of_part(r + 1);
      x[r].assign(mark.x.begin() + begin, mark.x.begin() + end);
      z[r].assign(mark.z.begin() + begin, mark.z.begin() + end);
    }
  }
  ranks_.broadcast(time);
  if (time.empty()) return {};
  x = ranks_.exchange(x), z = ranks_.exchange(z);  // all from the first rank
  return {{state_.step, time[0], std::move(x[0]), std::move(z[0])}};
}

Snapshot RankSimulation::take_part_of_snapshot() {
  ++state_.snapshots;
  auto contacts = contacts_of_part();
  auto marks = std::exchange(state_.marks, {});
  SimulationState part = state_;
  state_.marks = std::move(marks);
  part.bodies = bodies_of_part();
  part.marks = marks_of_part();
  const bool own_masses = ranks_.any(has_own_masses(part.bodies));  // of another part perhaps
  const StepLaws laws = laws_of(scene_, scales_);
  Snapshot snapshot = snapshot_of(
      {scene_, scales_, plan_, walls_, laws.period, laws.gravity.value_or(Point{}), own_masses}, part);
  snapshot.contacts = std::move(contacts);
  return snapshot;
}

ContactMemory RankSimulation::memory_of(const std::vector<RememberedContact>& in_order) const {
  const int dim = scene_.effects.friction ? 2 : 1;
  ContactMemory memory;
  memory.time_step = own_.memory_time_step;
  memory.i.reserve(in_order.size()), memory.j.reserve(in_order.size());
  memory.impulse.reserve(dim * in_order.size());
  for (const RememberedContact& contact : in_order) {
    memory.i.push_back(static_cast<std::int32_t>(contact.i));
    memory.j.push_back(static_cast<std::int32_t>(contact.j));
    for (int c = 0; c < dim; ++c) memory.impulse.push_back(contact.impulse[c]);
  }
  return memory;
}

SimulationState RankSimulation::gathered_state() const {
  SimulationState all = state_;
  all.bodies = gathered_bodies();
  auto memory = ranks_.gather<RememberedContact>(own_.memory);
  std::sort(memory.begin(), memory.end(), comes_before);
  all.memory = memory_of(memory);
  return all;
}

SimulationState RankSimulation::part_of_state() const {
  SimulationState part = state_;
  part.bodies = bodies_of_part();
  std::vector<RememberedContact> memory;
  for (const auto& of_rank : to_parts<RememberedContact>(own_.memory, [](const auto& c) { return c.i; }))
    memory.insert(memory.end(), of_rank.begin(), of_rank.end());
  std::sort(memory.begin(), memory.end(), comes_before);
  part.memory = memory_of(memory);
  return part;
}

double RankSimulation::kinetic_energy() const {
  ExactSum sum;
  for (const RankGrain& g : own_.grains) {
    const double rim = g.radius * g.spin;
    sum.add((g.v_x * g.v_x + g.v_z * g.v_z + rim * rim / 2) / (2 * g.inverse_mass));
  }
  ranks_.add(sum.numbers());
  return sum.value();
}

}  // namespace drumlin::particles
