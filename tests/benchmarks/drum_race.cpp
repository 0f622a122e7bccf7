#include "tests/benchmarks/drum_race.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>

#include "apps/json/json_file.hpp"
#include "apps/output/program.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/number_text.hpp"
#include "coupling/core/machine/own_costs.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/scene/scene_file.hpp"
#include "tests/benchmarks/flow_from_snapshot.hpp"

namespace drumlin::benchmark {

using namespace particles;
using Json = nlohmann::ordered_json;

void Looks::add_look(double x, double z) {
  slopes += std::atan2(-x, -z) * 180 / std::numbers::pi;
  ++count;
}

Corner drum_corner(int k) {
  const double angle = -2 * std::numbers::pi * k / drum_edges;
  return {std::cos(angle), std::sin(angle)};
}

namespace {

constexpr int look_every = 10;  // steps
struct OurSettings {
  double tolerance;
  std::optional<double> projection_share;
};
// The tolerance of the scene; the one at which our overlap is 1e-5 d, between the overlaps of 3e-3 and 1e-2;
// one at which it is less than that where the projection takes off three fifths of an overlap in a step; a
// rough one.
constexpr OurSettings our_settings[] = {{3e-3, {}}, {3.7e-3, {}}, {5.5e-3, 0.6}, {1e-2, {}}};

Scene with(const OurSettings& own, Scene scene) {
  scene.solver.tolerance = own.tolerance;
  scene.solver.projection_share = own.projection_share;
  return scene;
}

std::string name_of(const OurSettings& own) {
  const std::string name = fmt::format("drumlin, {:g}", own.tolerance);
  return own.projection_share ? fmt::format("{}, share {:g}", name, *own.projection_share) : name;
}

/// The scene in our engine.
class OurDrum final : public DrumEngine {
 public:
  OurDrum(const Scene& scene, const Snapshot& from) : simulation_(scene, state_at(scene, from)) {}

  void step() override {
    if (simulation_.finished())
      throw InputError("the last stage of the scene is too short for all stretches");
    report_ = simulation_.step();
  }
  void look(Looks& looks) const override {
    const Bodies& bodies = simulation_.state().bodies;
    // Before the projection of positions, which is harder.
    looks.overlap_sum += report_.overlap.mean * report_.overlap.loaded;
    looks.overlap_max = std::max(looks.overlap_max, report_.overlap.max);
    looks.contacts += report_.overlap.loaded;
    double x = 0, z = 0, mass = 0;
    for (std::size_t i = 0; i < bodies.count(); ++i) {
      const double m = 1 / bodies.inverse_mass[i];
      x += m * bodies.x[i], z += m * bodies.z[i], mass += m;
    }
    looks.add_look(x / mass, z / mass);
  }

 private:
  Simulation simulation_;
  StepReport report_;
};

double spin_rad_s(const Stage& stage) {
  for (const WallMotion& motion : stage.motions)
    if (const auto* rotation = std::get_if<Rotation>(&motion.motion))
      return rotation->speed_rpm * 2 * std::numbers::pi / 60;
  return 0;
}

FlowingDrum drum_of(const Scene& scene, const Snapshot& from) {
  const auto* container =
      scene.walls.size() == 1 ? std::get_if<ContainerShape>(&scene.walls[0].shape) : nullptr;
  const Effects& effects = scene.effects;
  if (container == nullptr || !effects.gravity || !effects.friction || !effects.restitution || !effects.spin)
    throw InputError("the scene is no smooth drum with gravity, friction, restitution and spin");
  if (from.spin.size() != from.x.size()) throw InputError("the snapshot has no spins");
  const Scales scales = scales_of(scene);
  FlowingDrum drum;
  drum.diameter = scales.length_m;
  drum.radius = container->radius_mm * 1e-3;
  drum.spin = spin_rad_s(scene.stages.back());
  drum.time_step = time_plan(scene, scales).stages.back().time_step * scales.time_s;
  const double angle = effects.gravity->direction_deg * std::numbers::pi / 180;
  const double g = effects.gravity->acceleration_m_s2;
  drum.gravity_x = g * std::cos(angle), drum.gravity_z = g * std::sin(angle);
  drum.friction_grains = effects.friction->grain_grain, drum.friction_drum = effects.friction->grain_wall;
  drum.restitution_grains = effects.restitution->grain_grain;
  drum.restitution_drum = effects.restitution->grain_wall;
  drum.resting_speed = 2 * g * drum.time_step;
  const double length = scales.length_m, velocity = scales.velocity_m_s();
  for (std::size_t i = 0; i < from.x.size(); ++i)
    drum.grains.push_back({from.x[i] * length, from.z[i] * length, from.v_x[i] * velocity,
                           from.v_z[i] * velocity, from.spin.at(i) / scales.time_s, from.radius[i] * length});
  return drum;
}

/// An engine with what has been measured of it.
struct Runner {
  std::string name;
  std::unique_ptr<DrumEngine> engine;
  std::vector<double> ms_per_step;  ///< processor time, one number per stretch
  std::vector<double> ms_of_steps;  ///< of all measured steps
  Looks looks;
};

void advance(Runner& runner, std::int64_t steps, bool measured) {
  double sum = 0;
  for (std::int64_t k = 1; k <= steps; ++k) {
    const double before = own_cpu_seconds();
    runner.engine->step();
    const double ms = 1e3 * (own_cpu_seconds() - before);
    if (!measured) continue;
    sum += ms, runner.ms_of_steps.push_back(ms);
    if (k % look_every == 0) runner.engine->look(runner.looks);
  }
  if (measured) runner.ms_per_step.push_back(sum / static_cast<double>(steps));
}

Json middle_and_range(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
  return {{"median", median}, {"least", values.front()}, {"largest", values.back()}};
}

/// What nine of ten steps exceed: of all numbers here the one that other processes disturb least.
double quick_step(const Runner& runner) {
  std::vector<double> ms = runner.ms_of_steps;
  const auto tenth = ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 10);
  std::nth_element(ms.begin(), tenth, ms.end());
  return *tenth;
}

Json to_json(const Runner& runner) {
  const Looks& looks = runner.looks;
  return {{"processor_ms_per_step", middle_and_range(runner.ms_per_step)},
          {"processor_ms_of_quick_step", quick_step(runner)},
          {"contacts_mean", looks.contacts / looks.count},
          {"overlap_mean", looks.overlap_sum / looks.contacts},
          {"overlap_max", looks.overlap_max},
          {"theta_com_deg", looks.slopes / looks.count}};
}

/// Time of `other` over that of `ours`, stretch by stretch.
Json speed_of(const Runner& ours, const Runner& other) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < ours.ms_per_step.size(); ++k)
    ratios.push_back(other.ms_per_step[k] / ours.ms_per_step[k]);
  Json speed = middle_and_range(ratios);
  speed["of_quick_steps"] = quick_step(other) / quick_step(ours);
  return speed;
}

/// Changes what NAME=VALUE words name.
void apply(const std::vector<std::string>& words, EngineSettings& settings) {
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (!settings.contains(name) || name == word)
      throw InputError(fmt::format("{}: no NAME=VALUE that this program knows", word));
    settings[name] = checked_number(word.substr(name.size() + 1), {"command line", 0, name});
  }
}

std::vector<Runner> runners_of(const Scene& scene, const Snapshot& from, const OtherEngine& other,
                               const EngineSettings& settings, bool ours) {
  std::vector<Runner> runners;
  runners.push_back({other.name, other.make(drum_of(scene, from), settings), {}, {}, {}});
  if (ours)
    for (const OurSettings& own : our_settings)
      runners.push_back(
          {name_of(own), std::make_unique<OurDrum>(with(own, last_stage_of(scene)), from), {}, {}, {}});
  return runners;
}

void race(const std::vector<std::string>& words, const OtherEngine& other) {
  EngineSettings settings = other.settings;
  settings.insert({{"skip", 0.2}, {"seconds", 0.2}, {"repeats", 5}, {"ours", 1}});
  apply({words.begin() + 3, words.end()}, settings);
  const Scene scene = read_scene(words[0]);
  const Snapshot from = read_snapshot(words[1]);
  const double load = load_average();
  const double h = drum_of(scene, from).time_step;
  const auto steps = std::llround(settings["seconds"] / h);
  if (steps < look_every || settings["repeats"] < 1)
    throw InputError(fmt::format("at least one stretch of {} steps", look_every));
  std::vector<Runner> runners = runners_of(scene, from, other, settings, settings["ours"] != 0);
  for (Runner& runner : runners) advance(runner, std::llround(settings["skip"] / h), false);
  for (int repeat = 0; repeat < settings["repeats"]; ++repeat)
    for (Runner& runner : runners) advance(runner, steps, true);
  std::string command = "PROGRAM SCENE SNAPSHOT RESULT";
  for (std::size_t k = 3; k < words.size(); ++k) command += " " + words[k];
  Json result{{"format", "drumlin-drum-race-1"},
              {"scene", scene.title},
              {"engine", other.name},
              {"version", other.version},
              {"settings", settings},
              {"units_per_metre", units_per_metre},
              {"drum_edges", drum_edges},
              {"command", command},
              {"threads", 1},
              {"time_step_s", h}};
  for (const Runner& runner : runners) result["engines"][runner.name] = to_json(runner);
  for (std::size_t k = 1; k < runners.size(); ++k)
    result["speed_against_" + other.name][runners[k].name] = speed_of(runners[k], runners[0]);
  result["load_before"] = load, result["load_after"] = load_average();
  result["provenance"] = provenance();
  fmt::print("{}\n", result.dump(2));
  apps::write_json(words[2], result);
}

}  // namespace

int race_drums(int argc, char** argv, const OtherEngine& other) {
  return apps::run_program([&] {
    if (argc < 4)
      throw InputError(fmt::format("usage: {} SCENE.toml SNAPSHOT.h5 RESULT.json [NAME=VALUE ...]", argv[0]));
    race({argv + 1, argv + argc}, other);
    return static_cast<int>(ExitCode::done);
  });
}

}  // namespace drumlin::benchmark
