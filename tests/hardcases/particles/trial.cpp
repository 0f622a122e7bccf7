#include "tests/hardcases/particles/trial.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include "tests/hardcases/hard_case.hpp"

namespace drumlin {
using namespace particles;
namespace {

constexpr double unit_mm = 1;
const double time_unit_s = std::sqrt(unit_mm * 1e-3 / 9.81);

}  // namespace

Trial::Trial() {
  scene.title = "hard case";
  scene.grains.density_kg_m3 = 1000;
  scene.solver.tolerance = 1e-9;
  scene.solver.penetration_tolerance = 1e-9;
  scene.solver.max_sweeps = 5000;
  scene.output.velocity_window_s = 0;
}

void Trial::add_stage(double duration, double time_step) {
  Stage stage;
  stage.name = "stage" + std::to_string(scene.stages.size() + 1);
  stage.duration_s = duration * time_unit_s;
  stage.time_step_s = time_step * time_unit_s;
  scene.stages.push_back(stage);
}

void Trial::turn(const std::string& wall, double spin) {
  scene.stages.back().motions.push_back(
      {wall, Rotation{spin / time_unit_s * 60 / (2 * std::numbers::pi), {0, 0}}});
}

Simulation Trial::start(int threads) const {
  Scene told = scene;
  // Sets the scales; the grains themselves come with the state.
  told.grains.source =
      GeneratedGrains{static_cast<int>(discs.size()), unit_mm, unit_mm, RectangleRegion{{0, 0}, {1, 1}}};
  SimulationState state;
  for (const TrialDisc& disc : discs) {
    add_body(state.bodies, disc.x, disc.z, disc.diameter / 2);
    state.bodies.v_x.back() = disc.v_x;
    state.bodies.v_z.back() = disc.v_z;
    if (disc.mass > 0) state.bodies.inverse_mass.back() = 1 / disc.mass;
    if (scene.effects.spin) state.bodies.spin.push_back(disc.spin);
  }
  std::set<std::string> walls;
  for (const Wall& wall : scene.walls) walls.insert(wall.name);
  state.pose_at_start.resize(walls.size());
  for (const WallMotion& motion : scene.stages.front().motions)
    if (std::holds_alternative<ForceControl>(motion.motion)) state.driven.emplace_back();
  return Simulation(told, std::move(state), threads);
}

Wall trial_segment(const std::string& name, double x0, double z0, double x1, double z1) {
  return {name, SegmentShape{{x0 * unit_mm, z0 * unit_mm}, {x1 * unit_mm, z1 * unit_mm}}};
}

Wall trial_floor() { return trial_segment("floor", -1000, 0, 1000, 0); }

Wall trial_container(double radius) { return {"drum", ContainerShape{{0, 0}, radius * unit_mm}}; }

std::vector<Wall> trial_box(double half) {
  return {trial_segment("floor", -half, -half, half, -half), trial_segment("top", -half, half, half, half),
          trial_segment("left", -half, -half, -half, half), trial_segment("right", half, -half, half, half)};
}

Watch run_watched(Simulation& simulation) {
  return run_watched(simulation, [](const Simulation&) {});
}

void detail::watch_step(Watch& watch, const Bodies& bodies, const StepReport& report, double kinetic_before) {
  ++watch.steps;
  bool finite = true;
  for (const auto* values : {&bodies.x, &bodies.z, &bodies.v_x, &bodies.v_z, &bodies.spin})
    for (const double value : *values) finite = finite && std::isfinite(value);
  watch.steps_not_finite += !finite;
  watch.steps_lost += report.lost.has_value();
  watch.steps_missed += report.contacts > 0 && report.solve.status != Status::converged;
  const double kinetic = kinetic_energy(bodies);
  watch.largest_kinetic = larger(watch.largest_kinetic, kinetic);
  watch.largest_rise = larger(watch.largest_rise, kinetic - kinetic_before);
  watch.largest_overlap = larger(watch.largest_overlap, report.overlap.max);
  watch.largest_mean_overlap = larger(watch.largest_mean_overlap, report.overlap.mean);
}

Bodies end_of(const Trial& trial, int threads) {
  Simulation simulation = trial.start(threads);
  while (!simulation.finished()) (void)simulation.step();
  return simulation.state().bodies;
}

double total_mass(const Bodies& bodies) {
  double mass = 0;
  for (const double inverse : bodies.inverse_mass) mass += 1 / inverse;
  return mass;
}

}  // namespace drumlin
