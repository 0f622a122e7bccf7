#include <fmt/format.h>

#include "apps/commands/cost/cost.hpp"
#include "apps/commands/run_files.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/interruption.hpp"
#include "apps/process/progress.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/described.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/measurement/motion_difference.hpp"
#include "particles/scene/physics.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/solver/solver_names.hpp"
#include "particles/stretches/effect_price.hpp"

namespace drumlin::particles {
DRUMLIN_DESCRIBED(Mark, cpu_seconds, steps, sweeps, contact_sweeps, missed, overlap_d)
DRUMLIN_DESCRIBED(MotionDifference, field, displacement, velocity, energy)
}  // namespace drumlin::particles

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

particles::SweepStart end_of_run(const fs::path& folder, const particles::Scene& scene) {
  const particles::RunFolder run = particles::read_run_folder(folder);
  if (!run.finished())
    throw InputError(fmt::format("{}: the run is unfinished (status {}); finish it with drumlin run --resume",
                                 folder.string(), name_of(run.status)));
  if (particles::scene_text(particles::physics_of(run.scene)) !=
      particles::scene_text(particles::physics_of(scene)))
    throw InputError(folder.string() +
                     ": is a run of another scene: grains, walls, effects and motions have to be the same");
  particles::SweepStart start{run.scene,
                              particles::read_checkpoint(checked_file(run.files, "checkpoint.h5")).state};
  start.scene.solver = scene.solver;
  start.scene.output = scene.output;
  start.scene.stages.push_back(scene.stages.back());
  return start;
}

particles::SimulationState last_stage_reached(const particles::Scene& scene, int threads) {
  Progress progress;
  particles::SimulationState state = particles::at_last_stage(scene, threads, [&](double share) {
    if (progress.due()) progress.show(fmt::format("to the last stage {:.0f} %", 100 * share));
    stop_if_interrupted();
  });
  progress.finish();
  return state;
}

particles::StretchSettings stretch_settings_of(const Json& wish) {
  return {wish.at("solver"), wish.at("tolerance"), wish.at("step_s"), wish.at("length_s")};
}

void keep(const fs::path& file, const particles::Scene& scene, const particles::SimulationState& state) {
  particles::Checkpoint checkpoint;
  checkpoint.scene = particles::scene_text(scene);
  checkpoint.state = state;
  particles::write_checkpoint(file, checkpoint);
}

fs::path file_at_mark(const std::string& prefix, std::size_t mark) {
  return fmt::format("{}-at-{}.h5", prefix, mark + 1);
}

}  // namespace

ParticleWork::ParticleWork(const CostOptions& options)
    : options_(options), scene_(particles::read_scene(options.scene, options.overrides)) {
  if (!options.effects) return;
  (void)particles::Simulation(scene_);
  variants_ = particles::effect_variants(scene_);
}

Json ParticleWork::facts() const {
  Json variants = Json::array();
  for (const particles::EffectVariant& one : variants_) {
    variants.push_back({{"effect", one.effect},
                        {"change", name_of(one.change)},
                        {"with_it", one.with_it},
                        {"refused", one.refused}});
  }
  return {{"kind", "particles"},
          {"title", scene_.title},
          {"reduced", scene_.reduced},
          {"scene", particles::scene_text(scene_)},
          {"solver", scene_.solver.name},
          {"tolerance", scene_.solver.tolerance},
          {"step_s", scene_.stages.back().time_step_s},
          {"last_stage", scene_.stages.size() - 1},
          {"solvers", particles::contact_solver_names()},
          {"variants", variants}};
}

void ParticleWork::begin(const fs::path& file) {
  if (options_.from)
    start_ = end_of_run(*options_.from, scene_);
  else
    start_.scene = scene_;
  start_.scene.output.energy_ledger = false;
  for (particles::Stage& stage : start_.scene.stages) stage.snapshots = 0;
  if (fs::exists(file)) {
    start_.state = particles::read_checkpoint(file).state;
    return;
  }
  if (!options_.from) start_.state = last_stage_reached(start_.scene, options_.threads);
  start_.state.energy.reset();
  start_.state.marks.clear();
  start_.state.snapshots = 0;
  keep(file, start_.scene, start_.state);
}

Json ParticleWork::stretch(const Json& wish) const {
  const particles::StretchSettings settings = stretch_settings_of(wish);
  const auto marks = particles::marks_along(start_, settings, options_.threads, stop_if_interrupted);
  Json list = Json::array();
  for (std::size_t m = 0; m < marks.size(); ++m) {
    const particles::Mark& mark = marks[m];
    list.push_back(mark);
    if (wish.contains("keep")) {
      particles::SimulationState state = start_.state;
      state.bodies = mark.bodies;
      keep(file_at_mark(wish["keep"], m), start_.scene, state);
      continue;
    }
    for (const std::string prefix : wish.at("against")) {
      const particles::Bodies there = particles::read_checkpoint(file_at_mark(prefix, m)).state.bodies;
      list.back()["against"].push_back(particles::motion_difference(start_.state.bodies, there, mark.bodies));
    }
  }
  if (wish.contains("keep")) return {{"marks", list}};
  return {{"marks", list},
          {"cpu_seconds", particles::least_seconds(start_, settings, options_.threads,
                                                   marks.back().cpu_seconds, stop_if_interrupted)}};
}

Json ParticleWork::lay_down(const Json& wish) const {
  const fs::path folder = wish.at("folder").get<std::string>(), run = folder / "run";
  if (!fs::exists(run / "checkpoint.h5")) {
    particles::Scene scene = particles::with_settings(start_.scene, stretch_settings_of(wish));
    scene.stages.back().snapshots = wish.at("snapshots");
    const GrowingOutput marked({run, ExistingOutput::resume, "run", {}}, run_file_names());
    keep(run / "checkpoint.h5", as_recorded(scene), start_.state);
    replace_file(folder / "scene.toml", particles::scene_text(scene));
  }
  return {{"steps", start_.state.step}};
}

Json ParticleWork::price(const Json& wish) const {
  const particles::Scene& scene = variants_.at(wish.at("variant")).scene;
  const particles::EffectPrice p =
      particles::price_of(scene, options_.seconds, options_.threads, stop_if_interrupted);
  return {{"cpu_seconds", p.cpu_seconds},
          {"detection_seconds", p.detection_seconds},
          {"solver_seconds", p.solver_seconds},
          {"bytes", p.bytes},
          {"unknowns", p.unknowns()},
          {"unknowns_per_contact", p.unknowns_per_contact},
          {"velocities_per_body", p.velocities_per_body},
          {"contacts", p.contacts},
          {"sweeps", p.sweeps},
          {"missed_share", p.missed},
          {"kinetic_energy_J_kg", p.kinetic_energy_J_kg},
          {"center_of_mass_mm", {p.center_x_mm, p.center_z_mm}},
          {"slope_deg", p.slope_deg},
          {"overlap_d", p.overlap_d}};
}

}  // namespace drumlin::apps
