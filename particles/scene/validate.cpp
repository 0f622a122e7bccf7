#include "particles/scene/validate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "particles/scene/longest_step.hpp"
#include "particles/scene/region.hpp"
#include "particles/scene/scene_walls.hpp"
#include "particles/scene/validate_cell.hpp"
#include "particles/scene/validate_grains.hpp"
#include "particles/scene/validate_materials.hpp"
#include "particles/scene/validate_names.hpp"
#include "particles/scene/validate_stages.hpp"
#include "particles/scene/validate_traffic.hpp"
#include "particles/solver/solver_names.hpp"

namespace drumlin::particles {

namespace {

using Faults = std::vector<SceneFault>;

constexpr double most_steps = 1e12;  // some 10,000 years of computing
constexpr double most_glued = 1e5;   // discs on one rough wall
// By which share a window may differ from whole steps, as adjusting the step of a stage of 50 can have it.
constexpr double most_adjusted = 1e-2;

double largest_diameter_mm(const Grains& grains) {
  const auto* generated = std::get_if<GeneratedGrains>(&grains.source);
  return generated ? generated->diameter_max_mm : 0;
}

void check_period(const Scene& scene, Faults& faults) {
  if (!scene.periodic_x) return;
  const auto [low, high] = *scene.periodic_x;
  const double length = high - low;
  // With fewer, a grain would meet the same neighbour on both sides.
  const double least = 3 * largest_diameter_mm(scene.grains);
  if (!(length > least))
    faults.push_back(
        {"periodic_x.x_max_mm",
         fmt::format("is {}", high),
         least > 0 ? fmt::format("beyond x_min_mm by more than 3 of the largest grains, > {}", low + least)
                   : fmt::format("> x_min_mm = {}", low),
         {"periodic_x", "grains.generated.diameter_max_mm"}});
  for (std::size_t w = 0; w < scene.walls.size(); ++w)
    if (std::holds_alternative<ContainerShape>(scene.walls[w].shape))
      faults.push_back({wall_key(w) + ".shape",
                        "is a container in a periodic domain",
                        "walls of other shapes, or a scene without periodic_x",
                        {"periodic_x", wall_key(w) + ".shape"}});
  if (const auto* grains = std::get_if<GeneratedGrains>(&scene.grains.source)) {
    const auto [left, right] = extent_mm(grains->region, 0);
    if (left < low || right > high)
      faults.push_back({"grains.generated.region",
                        fmt::format("reaches from x = {} to {} mm", left, right),
                        fmt::format("inside the domain, {} to {} mm", low, high),
                        {"periodic_x", "grains.generated.region"}});
  }
}

void check_roughness(const Wall& wall, const std::string& key, Faults& faults) {
  if (!wall.rough) return;
  const double length = wall_length_mm(wall);
  if (!(length / wall.rough->spacing_mm <= most_glued))
    faults.push_back({key + ".rough.spacing_mm",
                      fmt::format("makes {:.0f} discs", length / wall.rough->spacing_mm),
                      fmt::format("at most {:.0f}", most_glued),
                      {key}});
}

void check_walls(const Scene& scene, Faults& faults) {
  for (std::size_t w = 0; w < scene.walls.size(); ++w)
    check_field(scene.walls[w].name, wall_key(w) + ".name", faults);
  for (std::size_t w = 0; w < scene.walls.size(); ++w) check_roughness(scene.walls[w], wall_key(w), faults);
  for (std::size_t w = 0; w < scene.walls.size(); ++w)
    if (const auto* s = std::get_if<SegmentShape>(&scene.walls[w].shape); s && s->from_mm == s->to_mm)
      faults.push_back({wall_key(w) + ".to_mm",
                        "is where the segment begins",
                        "another point than from_mm",
                        {wall_key(w) + ".from_mm", wall_key(w) + ".to_mm"}});
}

void check_effects(const Scene& scene, Faults& faults) {
  each_effect(
      [&]<class E>(const std::optional<E>& effect) {
        if (!effect) return;
        const std::vector<SceneFault> of_effect = faults_of(*effect, scene);
        faults.insert(faults.end(), of_effect.begin(), of_effect.end());
      },
      scene.effects);
}

/// Of a motion of kind force or pressure.
template <class Drive>
void check_drive(const Scene& scene, const Drive& force, const std::string& key, Faults& faults) {
  const auto& e = force.direction;
  const auto& v = force.velocity_mm_s;
  const double length = std::hypot(e[0], e[1]), speed = std::hypot(v[0], v[1]);
  if (!(length > 0)) faults.push_back({key + ".direction", "has no length", "any other vector", {key}});
  if (std::abs(e[0] * v[0] + e[1] * v[1]) > relative_rounding * length * speed)
    faults.push_back({key + ".velocity_mm_s",
                      "has a part along the direction, which the force decides",
                      "at right angles to it",
                      {key}});
  if (scene.effects.rotating_frame)
    faults.push_back({key + ".kind",
                      "is a force in a rotating frame",
                      "a scene without effects.rotating_frame",
                      {key, "effects.rotating_frame"}});
}

/// What pushes a wall comes last, along a line of the laboratory; a pressure knows the length that it acts on
/// at the start of the stage.
void check_order(const Stage& stage, std::size_t m, const std::string& key, Faults& faults) {
  const auto& motions = stage.motions;
  const auto same = [&](const WallMotion& other) { return other.wall == motions[m].wall; };
  if (!is_driven(motions[m])) return;
  if (std::any_of(motions.begin() + m + 1, motions.end(), same))
    faults.push_back({key + ".kind",
                      fmt::format("pushes \"{}\" before another motion", motions[m].wall),
                      "force or pressure as the last motion of a wall",
                      {key}});
  const auto* pressure = std::get_if<PressureControl>(&motions[m].motion);
  const auto turns = [&](const WallMotion& other) {
    return same(other) &&
           (std::holds_alternative<Rotation>(other.motion) || std::holds_alternative<Rocking>(other.motion));
  };
  if (pressure && !pressure->between && std::any_of(motions.begin(), motions.begin() + m, turns))
    faults.push_back({key + ".between",
                      "is missing: the length of a wall that turns changes",
                      "two walls whose distance is pressed",
                      {key}});
}

void check_belt(const Scene& scene, const WallMotion& wall_motion, const std::string& key, Faults& faults) {
  if (!std::holds_alternative<Belt>(wall_motion.motion)) return;
  for (std::size_t w = 0; w < scene.walls.size(); ++w)
    if (scene.walls[w].name == wall_motion.wall && scene.walls[w].rough)
      faults.push_back(
          {key + ".kind",
           fmt::format("runs along \"{}\", whose glued discs would not follow", wall_motion.wall),
           "a wall without rough",
           {key, wall_key(w) + ".rough"}});
}

void check_motions(const Scene& scene, std::size_t s, Faults& faults) {
  for (std::size_t m = 0; m < scene.stages[s].motions.size(); ++m) {
    const std::string drive = fmt::format("{}.motions.{}", stage_key(s), m);
    if (const auto* force = std::get_if<ForceControl>(&scene.stages[s].motions[m].motion))
      check_drive(scene, *force, drive, faults);
    if (const auto* pressure = std::get_if<PressureControl>(&scene.stages[s].motions[m].motion))
      check_drive(scene, *pressure, drive, faults);
    check_order(scene.stages[s], m, drive, faults);
    check_belt(scene, scene.stages[s].motions[m], drive, faults);
  }
}

/// Exactly one length; turns only where something turns.
void check_length(const Stage& stage, const std::string& key, Faults& faults) {
  const std::vector<std::string> about = {key + ".duration_s", key + ".turns"};
  if (stage.duration_s && stage.turns)
    faults.push_back({key + ".turns", "excludes duration_s", "one of the two", about});
  if (!stage.duration_s && !stage.turns)
    faults.push_back({key + ".duration_s", "is missing", "either duration_s or turns", about});
  if (!stage.turns || stage.duration_s) return;
  for (const auto& motion : stage.motions)
    if (const auto* rotation = std::get_if<Rotation>(&motion.motion)) {
      if (rotation->speed_rpm == 0)
        faults.push_back({key + ".turns",
                          "counts the turns of a rotation of 0 rpm",
                          "duration_s instead",
                          {key + ".turns", key + ".motions"}});
      return;
    }
  faults.push_back({key + ".turns",
                    "has no rotation whose turns it counts",
                    "a motion of kind \"rotation\", or duration_s instead",
                    {key + ".turns", key + ".motions"}});
}

/// Steps, snapshots and the velocity window must fit into each other.
void check_steps(const Scene& scene, std::size_t s, Faults& faults) {
  const Stage& stage = scene.stages[s];
  const std::string key = stage_key(s);
  const double length = duration_s(stage), steps = steps_of(stage);
  const std::vector<std::string> about = {key + ".duration_s", key + ".turns", key + ".motions",
                                          key + ".time_step_s"};
  if (!(steps >= 1 && steps <= most_steps)) {
    if (std::isfinite(length))
      faults.push_back({key + ".time_step_s",
                        fmt::format("makes {:.6g} steps of the stage's {:.6g} s", steps, length),
                        fmt::format("1 to {:g} steps", most_steps), about});
    return;
  }
  if (stage.snapshots == 0) return;
  auto with = [&about](std::initializer_list<std::string> more) {
    std::vector<std::string> all = about;
    all.insert(all.end(), more);
    return all;
  };
  if (stage.snapshots > steps) {
    faults.push_back({key + ".snapshots", fmt::format("is {}", stage.snapshots),
                      fmt::format("at most one per step, <= {:.0f}", steps), with({key + ".snapshots"})});
    return;
  }
  // The step is so adjusted that whole steps fill the stage, and a prolonged stage names the adjusted one.
  const double window = scene.output.velocity_window_s / stage.time_step_s,
               adjusted = scene.output.velocity_window_s / (length / steps);
  const auto off = [](double n) { return std::abs(n - (n > 0 ? std::max(1.0, std::round(n)) : 0)); };
  if (off(window) > 1e-6 && off(adjusted) > most_adjusted * adjusted)
    faults.push_back({"output.velocity_window_s",
                      fmt::format("is {:.6g} steps of stage \"{}\"", window, stage.name),
                      fmt::format("a whole number of its steps of {} s", stage.time_step_s),
                      with({"output.velocity_window_s"})});
  else if (window > steps / stage.snapshots)
    faults.push_back({"output.velocity_window_s",
                      fmt::format("is longer than the {:.6g} s between two snapshots of stage \"{}\"",
                                  length / stage.snapshots, stage.name),
                      "at most that", with({"output.velocity_window_s", key + ".snapshots"})});
}

/// A wall that goes to and fro faster than steps follow looks slower, or at rest.
void check_frequencies(const Scene& scene, std::size_t s, Faults& faults) {
  constexpr double steps_per_period = 4;
  const Stage& stage = scene.stages[s];
  for (std::size_t m = 0; m < stage.motions.size(); ++m) {
    const auto& how = stage.motions[m].motion;
    const auto* shaking = std::get_if<Oscillation>(&how);
    const auto* rocking = std::get_if<Rocking>(&how);
    const double frequency = shaking ? shaking->frequency_hz : rocking ? rocking->frequency_hz : 0;
    const double most = 1 / (steps_per_period * stage.time_step_s);
    if (!(frequency > most)) continue;
    const std::string key = fmt::format("{}.motions.{}.frequency_hz", stage_key(s), m);
    faults.push_back(
        {key,
         fmt::format("is {}, a period of {:.3g} steps", frequency, 1 / (frequency * stage.time_step_s)),
         fmt::format("up to {:.6g} Hz, {} steps a period", most, steps_per_period),
         {key, stage_key(s) + ".time_step_s"}});
  }
}

void check_stages(const Scene& scene, Faults& faults) {
  std::set<std::string> names;
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    const auto& stage = scene.stages[s];
    check_name(stage.name, stage_key(s) + ".name", names, faults);
    check_motions(scene, s, faults);
    check_length(stage, stage_key(s), faults);
    check_steps(scene, s, faults);
    check_frequencies(scene, s, faults);
  }
  const std::vector<SceneFault> too_long = steps_too_long(scene, smallest_made_mm(scene));
  faults.insert(faults.end(), too_long.begin(), too_long.end());
}

void check_solver(const Scene& scene, Faults& faults) {
  const auto names = contact_solver_names();
  if (std::find(names.begin(), names.end(), scene.solver.name) == names.end())
    faults.push_back({"solver.name",
                      fmt::format("is \"{}\"", scene.solver.name),
                      fmt::format("\"{}\"; `drumlin solve-contacts --solver` has those for study",
                                  fmt::join(names, "\", \"")),
                      {"solver.name"}});
}

/// Files of contact problems hold grains and walls that only grains push.
void check_capture(const Scene& scene, Faults& faults) {
  const std::string key = "solver.capture_unconverged";
  if (scene.solver.capture_unconverged > 0 && moves_walls_by_force(scene))
    faults.push_back({key,
                      "requires contact problems with walls moved by a force, which their files cannot hold",
                      "0, or no motion of kind force",
                      {key, "stages"}});
}

}  // namespace

std::string wall_key(std::size_t w) { return fmt::format("walls.{}", w); }

std::string stage_key(std::size_t s) { return fmt::format("stages.{}", s); }

std::vector<SceneFault> validate(const Scene& scene) {
  Faults faults;
  check_grains(scene, faults);
  check_period(scene, faults);
  check_cell(scene, faults);
  check_walls(scene, faults);
  check_materials(scene, faults);
  check_effects(scene, faults);
  check_stages(scene, faults);
  check_stage_changes(scene, faults);
  check_traffic(scene, faults);
  if (scene.solver.check_every > scene.solver.max_sweeps)
    faults.push_back({"solver.check_every",
                      fmt::format("is {}", scene.solver.check_every),
                      fmt::format("<= max_sweeps = {}", scene.solver.max_sweeps),
                      {"solver.check_every", "solver.max_sweeps"}});
  check_solver(scene, faults);
  check_capture(scene, faults);
  return faults;
}

}  // namespace drumlin::particles
