// What stages and callers change while a simulation runs, and what it looks at in scenes that ask for it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/core/basics/errors.hpp"
#include "particles/stepping/lost_grain.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {
namespace {

/// Whether the middle of a wall's first shape has gone so far since the stage began.
bool has_moved(const UntilMoved& asked, const Walls& walls, double time_in_stage,
               std::span<const DrivenState> driven, const Scales& scales) {
  const auto wall =
      static_cast<int>(std::find(walls.names.begin(), walls.names.end(), asked.wall) - walls.names.begin());
  const Point middle = middle_of(walls.reference[first_shape(walls, wall)]);
  const Point then = moved(walls.pose_at_start[wall], middle);
  const Point now = moved(walls.pose(wall, time_in_stage, driven), middle);
  return std::hypot(now.x - then.x, now.z - then.z) >= asked.distance_mm * 1e-3 / scales.length_m;
}

bool has_taken(const UntilOut& asked, const Scene& scene, const Traffic& traffic) {
  for (std::size_t o = 0; o < scene.outlets.size(); ++o)
    if (scene.outlets[o].name == asked.outlet)
      return traffic.outlets[o].taken() - traffic.outlets[o].at_stage_start >= asked.count;
  return false;
}

void require_free(const Stage& stage, const std::string& wall) {
  const auto refuse = [&](const std::string& why) {
    throw InputError({InputProblem{"", 0, 0, wall, why, "a wall that motions of the stage alone move"}});
  };
  for (const WallMotion& motion : stage.motions)
    if (motion.wall == wall && is_driven(motion)) refuse("is moved by a force in stage " + stage.name);
  if (stage.until && stage.until->moved && stage.until->moved->wall == wall)
    refuse("ends stage " + stage.name + " when it has moved");
}

}  // namespace

int Simulation::next_stage() const {
  const bool over = state_.step_in_stage == plan_.stages[state_.stage].steps && !finished();
  return state_.stage + (over ? 1 : 0);
}

void Simulation::change_stage(const Stage& changed, const std::string& moved) {
  const int k = next_stage();
  Stage& stage = scene_.stages[k];
  if (!moved.empty()) require_free(stage, moved);
  stage.duration_s = changed.duration_s, stage.turns = changed.turns;
  stage.gravity = changed.gravity, stage.effects = changed.effects, stage.motions = changed.motions;
  stage.cell = changed.cell;
  if (changes_gravity(scene_) && !state_.gravity) state_.gravity = scene_.effects.gravity;
  const Walls& walls = setting_.walls;
  const auto w = std::find(walls.names.begin(), walls.names.end(), moved) - walls.names.begin();
  const bool goes_on = !moved.empty() && k == state_.stage;
  const auto pose = [&] { return walls.pose(static_cast<int>(w), state_.time_in_stage); };
  const Pose now = goes_on ? pose() : Pose{};
  make_setting();  // ends stay joined where walls move together
  if (!goes_on) return;
  setting_.walls.pose_at_start[w] = {};
  setting_.walls.pose_at_start[w] = after(inverse(pose()), now);
  state_.pose_at_start = walls.pose_at_start;
}

void Simulation::set_velocities(std::span<const double> v_x, std::span<const double> v_z,
                                std::span<const double> spin) {
  Bodies bodies = state_.bodies;
  if (scene_.output.energy_ledger)
    throw InputError("output.energy_ledger: has no account for velocities that a caller sets");
  if (v_x.size() != bodies.count() || v_z.size() != bodies.count() || spin.size() != bodies.spin.size())
    throw InputError("velocities: are not one for each grain");
  bodies.v_x.assign(v_x.begin(), v_x.end());
  bodies.v_z.assign(v_z.begin(), v_z.end());
  bodies.spin.assign(spin.begin(), spin.end());
  auto wrong = grain_that_is_not_finite(bodies);
  if (!wrong) wrong = grain_too_fast(bodies, plan_.stages[next_stage()].time_step);
  if (wrong) throw InputError(fmt::format("velocity: grain {} {}", wrong->grain, to_string(wrong->how)));
  // Into the arrays that are there: others may look at them.
  std::copy(v_x.begin(), v_x.end(), state_.bodies.v_x.begin());
  std::copy(v_z.begin(), v_z.end(), state_.bodies.v_z.begin());
  std::copy(spin.begin(), spin.end(), state_.bodies.spin.begin());
}

void Simulation::count_left() {
  const Bodies& bodies = state_.bodies;
  std::optional<Extent> now;
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    if (!is_gone(extent_, bodies.x[b], bodies.z[b]) || (state_.left && state_.left->has_left[b])) continue;
    if (!now) now = with_shapes(extent_, setting_.walls.shapes_at(state_.time_in_stage, state_.driven));
    if (!is_gone(*now, bodies.x[b], bodies.z[b])) continue;
    if (!state_.left)
      state_.left = {
          std::vector<std::uint8_t>(bodies.count()), std::vector<std::int64_t>(plan_.stages.size()), {}};
    state_.left->has_left[b] = 1;
    ++state_.left->per_stage[state_.stage];
    if (state_.left->first.size() < named_left)
      state_.left->first.push_back(
          {bodies.id.empty() ? static_cast<std::int64_t>(b) : bodies.id[b], state_.stage, state_.time()});
  }
}

void Simulation::end_stage_if_due() {
  if (!ends_stages_early(scene_)) return;
  const double h = plan_.stages[state_.stage].time_step;
  const auto& until = scene_.stages[state_.stage].until;
  std::optional<EndedBy> by;
  if (until && until->at_rest) {
    const double weight = std::numbers::pi / 4;  // of a disc of the mean diameter
    const auto grains = static_cast<double>(std::max<std::size_t>(1, state_.bodies.count()));
    const double drift = state_.cell ? energy_of_drift(state_.bodies) : 0;
    const double energy = (kinetic_energy(state_.bodies) - drift) / grains;
    state_.rest_steps = energy < until->at_rest->energy * weight ? state_.rest_steps + 1 : 0;
    const double rested = static_cast<double>(state_.rest_steps) * h * scales_.time_s;
    if (state_.rest_steps > 0 && rested >= until->at_rest->for_s * (1 - 1e-9)) by = EndedBy::rest;
  }
  if (!by && until && until->moved &&
      has_moved(*until->moved, setting_.walls, state_.time_in_stage, state_.driven, scales_))
    by = EndedBy::wall;
  if (!by && until && until->out && has_taken(*until->out, scene_, *state_.traffic)) by = EndedBy::outlet;
  if (!by && state_.step_in_stage < plan_.stages[state_.stage].steps) return;
  state_.ends.push_back({state_.step_in_stage, by.value_or(EndedBy::its_time)});
  state_.rest_steps = 0;
  plan_ = time_plan(scene_, scales_, state_.ends);
}

/// A step of length 0 begins an interval.
void Simulation::add_wall_loads(double time_step) {
  const auto shapes = setting_.walls.shapes_at(state_.time_in_stage, state_.driven);
  std::vector<double> angles;
  for (std::size_t w = 0; w < setting_.walls.names.size(); ++w)
    angles.push_back(setting_.walls.pose(static_cast<int>(w), state_.time_in_stage, state_.driven).angle);
  if (time_step == 0)
    begin_interval(setting_.walls, shapes, angles, *state_.loads);
  else
    add_step(setting_.walls, shapes, angles, stepper_->wall_contacts(), state_.bodies, time_step,
             *state_.loads);
}

bool Simulation::wall_loads_due() const {
  if (!state_.loads || !(state_.loads->time > 0)) return false;
  return finished() || state_.loads->time * scales_.time_s >= *scene_.output.walls_every_s * (1 - 1e-9);
}

WallLoads Simulation::take_wall_loads() {
  WallLoads over = *state_.loads;
  state_.loads.emplace();
  return over;
}

}  // namespace drumlin::particles
