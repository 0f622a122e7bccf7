#include "particles/stepping/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/longest_step.hpp"
#include "particles/scene/materials.hpp"
#include "particles/scene/placement.hpp"
#include "particles/scene/scene_walls.hpp"
#include "particles/scene/thermal.hpp"
#include "particles/stepping/scene_solver.hpp"
#include "particles/stepping/snapshot_of_state.hpp"
#include "particles/stepping/standing_start.hpp"

namespace drumlin::particles {
namespace {

bool fits(const Traffic& traffic, const Scene& scene, const Bodies& bodies) {
  const bool ascending =
      std::adjacent_find(bodies.id.begin(), bodies.id.end(), std::greater_equal<>()) == bodies.id.end();
  const auto materials = static_cast<std::int32_t>(material_names(scene).size()) + 1;
  for (const OutletState& outlet : traffic.outlets)
    for (const WaitingGrain& grain : outlet.waiting)
      if (grain.material >= materials) return false;
  return traffic.outlets.size() == scene.outlets.size() && traffic.poured.size() == scene.sources.size() &&
         bodies.id.size() == bodies.count() && ascending &&
         (bodies.id.empty() || bodies.id.back() < traffic.next_id);
}

/// A state from a file must fit its scene before anything indexes it.
void check_state(const SimulationState& s, const Scene& scene, const TimePlan& plan, const Walls& walls) {
  const auto require = [](bool good, const char* what) {
    if (!good) throw InputError(std::string("checkpoint: ") + what + " do not fit the scene");
  };
  const auto unknowns = static_cast<std::size_t>(unknowns_of(contact_law_of(scene.effects)));
  const std::size_t n = s.bodies.count(), contacts = s.memory.i.size();
  for (const auto* values :
       {&s.bodies.z, &s.bodies.v_x, &s.bodies.v_z, &s.bodies.radius, &s.bodies.inverse_mass})
    require(values->size() == n, "arrays of the grains");
  require(s.traffic.has_value() == changes_grains(scene) && (!s.traffic || fits(*s.traffic, scene, s.bodies)),
          "outlets and sources");
  require((n > 0 || s.traffic) && s.bodies.spin.size() == (scene.effects.spin ? n : 0),
          "spins of the grains");
  require(!grain_that_is_not_finite(s.bodies), "numbers of the grains");
  const auto numbers = material_names(scene).size() + 1;
  require(s.bodies.material.size() == (materials_matter(scene) ? n : 0) &&
              std::all_of(s.bodies.material.begin(), s.bodies.material.end(),
                          [numbers](std::uint8_t m) { return m < numbers; }),
          "materials of the grains");
  require(s.stage >= 0 && s.stage < static_cast<int>(plan.stages.size()), "stages");
  require(s.step >= 0 && s.step <= plan.steps && s.step_in_stage >= 0 &&
              s.step_in_stage <= plan.stages[s.stage].steps,
          "steps");
  require(s.ends.size() <= plan.stages.size() &&
              (!ends_stages_early(scene) || s.ends.size() >= static_cast<std::size_t>(s.stage)),
          "ends of stages");
  require(s.gravity.has_value() == changes_gravity(scene), "gravity of stages");
  require(s.loads.has_value() == scene.output.walls_every_s.has_value() &&
              (!s.loads || s.loads->walls.empty() || s.loads->walls.size() == walls.names.size()),
          "loads on walls");
  require(!s.left || (s.left->has_left.size() == n && s.left->per_stage.size() == plan.stages.size()),
          "grains that have left");
  require(s.cell.has_value() == moves_cell(scene), "the cell");
  require(s.pose_at_start.size() == walls.names.size(), "walls");
  require(s.memory.j.size() == contacts && s.memory.impulse.size() == unknowns * contacts, "contacts");
  const auto shapes = static_cast<std::int64_t>(walls.wall_of_shape.size());
  for (std::size_t c = 0; c < contacts; ++c)
    require(s.memory.i[c] >= 0 && s.memory.i[c] < static_cast<std::int64_t>(n) && s.memory.j[c] >= -shapes &&
                s.memory.j[c] < static_cast<std::int64_t>(n),
            "contacts");
  for (const auto& mark : s.marks) require(mark.x.size() == n && mark.z.size() == n, "displacement windows");
}

void refuse_deep_overlap(const Scene& scene, const Walls& walls, const StartOverlaps& overlaps) {
  if (!(overlaps.depth > most_at_start)) return;
  const std::string second =
      overlaps.j >= 0 ? fmt::format("grain {}", overlaps.j + 1)
                      : fmt::format("wall \"{}\"", walls.names[walls.wall_of_shape[-1 - overlaps.j]]);
  const auto* list = std::get_if<ListedGrains>(&scene.grains.source);
  throw InputError({InputProblem{
      list ? list->file.string() : "", 0, 0, "x_mm, z_mm, diameter_mm",
      fmt::format("grain {} overlaps {} by {:.3g} of a diameter, {} pairs overlap in all", overlaps.i + 1,
                  second, overlaps.depth, overlaps.pairs),
      fmt::format("at most {} of the smaller diameter; grains are counted from 1", most_at_start)}});
}

/// Listed grains only show here; what a scene makes of them is told with its keys.
void refuse_steps_too_long(const Scene& scene, const Scales& scales, const TimePlan& plan,
                           const Bodies& bodies) {
  const double smallest = 2 * *std::min_element(bodies.radius.begin(), bodies.radius.end());
  const double smallest_mm = std::min(smallest * scales.length_m * 1e3, smallest_made_mm(scene));
  std::vector<InputProblem> problems;
  for (const SceneFault& fault : steps_too_long(scene, smallest_mm))
    problems.push_back({"", 0, 0, fault.key, fault.what, fault.allowed});
  const double h = plan.stages[0].time_step;
  if (const auto fast = grain_too_fast(bodies, h); fast && problems.empty())
    problems.push_back(
        {"", 0, 0, "stages.0.time_step_s",
         fmt::format("is {}, in which grain {} flies by {:.3g} mean diameters", scene.stages[0].time_step_s,
                     fast->grain + 1, h * std::hypot(bodies.v_x[fast->grain], bodies.v_z[fast->grain])),
         fmt::format("one in which none flies further than {:g}", longest_flight)});
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace

Scales scales_of(const Scene& scene) {
  const double g = scene.effects.gravity ? scene.effects.gravity->acceleration_m_s2 : 9.81;
  return drumlin::scales_of(mean_diameter_m(scene.grains), g > 0 ? g : 9.81, scene.grains.density_kg_m3);
}

Simulation::Simulation(SimulationState state, const Scene& scene, int threads, World* world)
    : scene_(scene),
      scales_(scales_of(scene)),
      plan_(time_plan(scene, scales_, state.ends)),
      setting_{walls_of(scene, scales_), laws_of(scene, scales_)},
      extent_(extent_of(scene, scales_, setting_.walls)),
      state_(std::move(state)),
      stepper_(make_stepper(setting_.laws, solver_of(scene, threads, world))) {}

Simulation::Simulation(const Scene& scene, int threads, World* world)
    : Simulation(SimulationState{}, scene, threads, world) {
  state_.bodies = place_grains(scene, scales_);
  if (scene.grains.thermal_speed_mm_s)
    add_thermal_motion(*scene.grains.thermal_speed_mm_s * 1e-3 / scales_.velocity_m_s(), scene.seed,
                       state_.bodies);
  if (changes_gravity(scene)) state_.gravity = scene.effects.gravity;
  if (scene.output.walls_every_s) state_.loads.emplace();
  if (changes_grains(scene)) state_.traffic = first_traffic(scene, state_.bodies);
  const StepLaws& laws = setting_.laws;
  if (moves_cell(scene)) {
    state_.cell = cell_at_rest(laws.period);
    wrap_grains(*state_.cell, state_.bodies);
  }
  state_.pose_at_start = setting_.walls.pose_at_start;
  const auto gravity = laws.gravity;  // in which grains were placed: stages may change it
  state_.driven = make_setting();
  const auto shapes = setting_.walls.shapes_at(0, state_.driven);
  if (starts_deposited(scene) && gravity)
    state_.memory = impulses_under_weight(state_.bodies, shapes, laws.period, *gravity,
                                          plan_.stages[0].time_step, unknowns_of(laws.contact_law));
  if (Scene asked = scene; !lists_of(asked).empty()) {
    start_overlaps_ = overlaps_at_start(state_.bodies, shapes,
                                        resting_steps(setting_.walls, state_.bodies.material), laws.period);
    refuse_deep_overlap(scene, setting_.walls, start_overlaps_);
    refuse_steps_too_long(scene, scales_, plan_, state_.bodies);
  }
}

Simulation::Simulation(const Scene& scene, SimulationState state, int threads, World* world)
    : Simulation(std::move(state), scene, threads, world) {
  check_state(state_, scene_, plan_, setting_.walls);
  put_in_order(state_.memory);  // older checkpoints have it in the order of the solve
  if (make_setting().size() != state_.driven.size())
    throw InputError("checkpoint: walls moved by a force do not fit the scene");
}

Simulation::~Simulation() = default;

EventInput Simulation::event_input() {
  return {scene_, scales_, plan_.stages[state_.stage].time_step, setting_, state_};
}

void Simulation::apply_events(bool each_step) {
  for (const Event& event : events_)
    if (event.each_step == each_step && event.from <= state_.stage && state_.stage < event.end)
      event.apply(scene_.stages[event.from], event_input());
}

std::vector<DrivenState> Simulation::make_setting() {
  setting_ = {walls_of(scene_, scales_), laws_of(scene_, scales_)};
  setting_.walls.pose_at_start = state_.pose_at_start;
  events_ = events_of(scene_);
  const auto driven = state_.driven;
  apply_events(false);
  return std::exchange(state_.driven, driven);
}

void Simulation::enter_next_stage() {
  if (state_.gravity) state_.gravity = gravity_at(event_input(), state_.time_in_stage);
  // Those of a stage that may end at any step are made for snapshots that are not to come.
  if (scene_.stages[state_.stage].until) state_.marks.clear();
  ++state_.stage;
  apply_events(false);
  state_.step_in_stage = 0;
  state_.time_at_stage_start += state_.time_in_stage;
  state_.time_in_stage = 0;
  state_.pose_at_start = setting_.walls.pose_at_start;
  if (state_.traffic)
    for (OutletState& outlet : state_.traffic->outlets) outlet.at_stage_start = outlet.taken();
}

void Simulation::mark_positions() {
  if (scene_.output.velocity_window_s <= 0) return;
  const double window = scene_.output.velocity_window_s / scales_.time_s;
  // Steps of the current stage stand for the window, also where it reaches into the next one.
  const auto steps = std::max<std::int64_t>(1, std::llround(window / plan_.stages[state_.stage].time_step));
  const bool may_end = scene_.stages[state_.stage].until && scene_.stages[state_.stage].snapshots > 0;
  if (may_end)
    while (!state_.marks.empty() && state_.marks.front().snapshot_step <= state_.step)
      state_.marks.pop_front();
  if (may_end ||
      std::binary_search(plan_.snapshot_steps.begin(), plan_.snapshot_steps.end(), state_.step + steps))
    state_.marks.push_back({state_.step + steps, state_.time(), state_.bodies.x, state_.bodies.z});
}

StepReport Simulation::step() {
  if (state_.step_in_stage == plan_.stages[state_.stage].steps) enter_next_stage();
  apply_events(true);
  mark_positions();
  const double h = plan_.stages[state_.stage].time_step;
  if (state_.loads && state_.loads->time == 0) add_wall_loads(0);
  StepReport report = setting_.laws.rotating_frame ? advance_in_laboratory(h) : advance_here(h);
  if (!report.lost) report.lost = grain_that_is_not_finite(state_.bodies);
  if (!report.lost) report.lost = grain_too_fast(state_.bodies, h);
  for (const DrivenState& wall : state_.driven)
    if (!report.lost && (!std::isfinite(wall.position) || !std::isfinite(wall.velocity)))
      throw NotConvergedError("a wall that a force moves has no finite place or speed any more");
  ++state_.step;
  ++state_.step_in_stage;
  state_.time_in_stage = static_cast<double>(state_.step_in_stage) * h;
  if (state_.loads) add_wall_loads(h);
  count_left();
  end_stage_if_due();
  return report;
}

StepReport Simulation::advance_here(double h) {
  WallStep walls = wall_step(setting_.walls, state_.time_in_stage, h, state_.driven, state_.bodies.material);
  MovingState moving{setting_.laws, state_.bodies, state_.memory, state_.driven, state_.energy};
  if (!state_.cell) return stepper_->advance(moving, walls, h);
  moving.cell.emplace(begin_cell_step(h));
  const CellState begun = *state_.cell;
  const StepReport report = stepper_->advance(moving, walls, h);
  end_cell_step(begun, h);
  return report;
}

StepReport Simulation::advance_in_laboratory(double h) {
  const TurningFrame frame = *setting_.laws.rotating_frame;
  const double time = state_.time();
  to_laboratory(frame, time, state_.bodies);
  WallStep walls = in_laboratory(
      frame, time, h, wall_step(setting_.walls, state_.time_in_stage, h, {}, state_.bodies.material));
  const StepReport report =
      stepper_->advance({setting_.laws, state_.bodies, state_.memory, {}, state_.energy}, walls, h);
  from_laboratory(frame, time + h, state_.bodies);
  return report;
}

bool Simulation::snapshot_due() const {
  return std::binary_search(plan_.snapshot_steps.begin(), plan_.snapshot_steps.end(), state_.step);
}

Point Simulation::normal_in_scene(double n_x, double n_z) const {
  const auto& frame = setting_.laws.rotating_frame;
  if (!frame) return {n_x, n_z};
  // Normals are those of the beginning of the step.
  return direction_in_frame(*frame, state_.time() - plan_.stages[state_.stage].time_step, {n_x, n_z});
}

ContactPlaces Simulation::last_places() const {
  ContactPlaces places;
  const Bodies& bodies = state_.bodies;
  for (const Candidate& pair : stepper_->last_pairs()) {
    const Point normal = normal_in_scene(pair.n_x, pair.n_z);
    places.x.push_back(bodies.x[pair.i] - bodies.radius[pair.i] * normal.x);
    places.z.push_back(bodies.z[pair.i] - bodies.radius[pair.i] * normal.z);
    places.normal_x.push_back(normal.x), places.normal_z.push_back(normal.z);
  }
  return places;
}

std::vector<SnapshotContact> Simulation::last_contacts() const {
  std::vector<SnapshotContact> contacts = stepper_->loaded_contacts();
  for (SnapshotContact& contact : contacts) {
    const Point normal = normal_in_scene(contact.normal_x, contact.normal_z);
    contact.normal_x = static_cast<float>(normal.x), contact.normal_z = static_cast<float>(normal.z);
  }
  return contacts;
}

Snapshot Simulation::take_snapshot() {
  ++state_.snapshots;
  const StepLaws& laws = setting_.laws;
  Point gravity = laws.gravity.value_or(Point{});
  if (state_.gravity) gravity = law_of(gravity_at(event_input(), state_.time_in_stage), {scales_, {}});
  if (laws.rotating_frame) gravity = direction_in_frame(*laws.rotating_frame, state_.time(), gravity);
  Snapshot s = snapshot_of({scene_, scales_, plan_, setting_.walls, laws.period, gravity}, state_);
  s.contacts = last_contacts();
  return s;
}

}  // namespace drumlin::particles
