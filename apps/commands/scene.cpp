// drumlin scene check | show | list | file | keys
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.hpp"
#include "apps/commands/effects_text.hpp"
#include "apps/commands/expected_output.hpp"
#include "apps/commands/run_report.hpp"
#include "apps/commands/start_grains.hpp"
#include "apps/process/program_files.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/documents/document.hpp"
#include "particles/scene/placement.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {

namespace {

struct SceneOptions {
  std::filesystem::path scene;
  std::vector<std::string> overrides;

  void describe(Description& d) {
    d.scene(scene, "Scene file");
    d.changes(overrides);
  }
};

struct FileOptions {
  std::string name;
  bool law = false;

  void describe(Description& d) {
    d.add("name", name, "NAME",
          "Of a scene that drumlin scene list names; with --law of one of data/rheology")
        .required();
    d.add("--law", law, "The file of a law");
  }
};

struct KeysOptions {
  bool markdown = false;

  void describe(Description& d) { d.add("--markdown", markdown, "As a table in Markdown"); }
};

struct NoOptions {
  void describe(Description&) {}
};

/// Makes the simulation too: what only shows there is a fault of the scene.
int check_scene(const SceneOptions& options) {
  particles::Scene scene = particles::read_scene(options.scene, options.overrides);
  (void)take_over_grains(scene);
  const Scales scales = scales_of(scene);
  const particles::TimePlan plan = particles::time_plan(scene, scales);
  const particles::Simulation simulation(scene);
  const auto grains = simulation.state().bodies.count();
  const auto shapes = particles::walls_of(scene, scales).reference.size();
  const int unknowns = simulation.stepper().unknowns_per_contact();
  print_out(fmt::format("{}: ok{}\n", options.scene.string(), scene.reduced ? " (reduced)" : ""));
  if (!scene.title.empty()) print_out(fmt::format("title      {}\n", scene.title));
  print_out(fmt::format("grains     {}, mean diameter {:.4g} mm, sqrt(d/g) {:.4g} s\n", grains,
                        scales.length_m * 1e3, scales.time_s));
  print_out(fmt::format("walls      {} shapes{}\n", shapes,
                        scene.periodic_z   ? ", periodic in x and z"
                        : scene.periodic_x ? ", periodic in x"
                                           : ""));
  print_out(fmt::format("effects    {}; {} unknown{} per contact\n", effects_text(scene.effects), unknowns,
                        unknowns > 1 ? "s" : ""));
  print_out(fmt::format("solver     {}, tolerance {}, at most {} sweeps\n", scene.solver.name,
                        scene.solver.tolerance, scene.solver.max_sweeps));
  double seconds = 0;
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    seconds += particles::duration_s(scene.stages[s]);
    print_out(fmt::format("stage      {}: {}{:.6g} s in {} steps of {:.6g} s, {} snapshots\n",
                          scene.stages[s].name, scene.stages[s].until ? "at most " : "",
                          particles::duration_s(scene.stages[s]), plan.stages[s].steps,
                          plan.stages[s].time_step * scales.time_s, scene.stages[s].snapshots));
  }
  print_out(fmt::format("in all     {}{:.6g} s, {} steps, {} snapshots\n",
                        ends_stages_early(scene) ? "at most " : "", seconds, plan.steps,
                        plan.snapshot_steps.size()));
  print_out(fmt::format("output     {}\n", expected_output_text(expected_output(
                                               scene, grains, plan.snapshot_steps.size(), plan.steps))));
  if (const std::string warning = start_warning(simulation.start_overlaps()); !warning.empty())
    print_out(fmt::format("warning: {}\n", warning));
  return 0;
}

/// Names and titles, in the order of the names.
int list_scenes(const NoOptions&) {
  std::vector<std::filesystem::path> scenes;
  for (const auto& file : std::filesystem::directory_iterator(data_folder() / "scenes"))
    if (file.path().extension() == ".toml") scenes.push_back(file.path());
  std::sort(scenes.begin(), scenes.end());
  for (const auto& file : scenes) {
    const Document document = read_toml(file);
    const Node* title = document.root.find("title");
    const auto* text = title != nullptr ? std::get_if<std::string>(&title->value) : nullptr;
    print_out(fmt::format("{:<22} {}\n", file.stem().string(), text != nullptr ? *text : ""));
  }
  return 0;
}

int print_file(const FileOptions& options) {
  print_out((options.law ? shipped_law(options.name) : shipped_scene_of_any_kind(options.name)) + "\n");
  return 0;
}

int show_scene(const SceneOptions& options) {
  print_out(particles::scene_text(particles::read_scene(options.scene, options.overrides)));
  return 0;
}

int list_keys(const KeysOptions& options) {
  print_out(options.markdown ? keys_as_markdown(particles::scene_keys())
                             : keys_as_text(particles::scene_keys()));
  return 0;
}

}  // namespace

Command scene_command() {
  return {"scene",
          "Checks, shows and explains scene files",
          nullptr,
          {command("check", "Validates a scene and says what it amounts to", check_scene),
           command("show", "Prints a scene with all its defaults", show_scene),
           command("list", "Lists the shipped scenes, which every command finds by their names", list_scenes),
           command("file", "Says where a shipped scene or law lies, to copy it", print_file),
           command("keys", "Lists every key with unit, range, default and meaning", list_keys)}};
}

}  // namespace drumlin::apps
