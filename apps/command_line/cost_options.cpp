// Options of drumlin cost.
#include <CLI/CLI.hpp>

#include "apps/command_line/checked_options.hpp"
#include "apps/command_line/command_options.hpp"

namespace drumlin::apps {

void add_cost_options(CLI::App& command, CostOptions& options) {
  add_scene_file(command, options.scene, "Scene of particles or of a flow");
  command
      .add_option("--sweep", options.sweep,
                  "What is varied, each with its values or standard ones, e.g. tolerance=1e-2:1e-3,step; "
                  "particles: solver, tolerance, step; flows: mesh, eps, tolerance [all]")
      ->delimiter(',')
      ->type_name("NAME[=VALUE:...],...");
  add_optional_number(
      command, "--horizon", options.horizon_s, "s", above(0),
      "Particles: longest stretch after which velocities are compared; half or a quarter of it "
      "where the finest point leaves the reference earlier; standard: 16 steps of the scene");
  add_optional_number(command, "--statistics", options.statistics_s, "s", above(0),
                      "Particles: compares the measured numbers of runs of this length as well");
  add_optional_path(command, "--from", options.from, "RUN",
                    "Particles: finished run of the scene to start from; standard: the beginning of the last "
                    "stage, which is run up to first");
  add_optional_path(command, "--rheology", options.rheology, "RHEOLOGY.toml",
                    "Flows: law, from calibrate or data/rheology");
  add_numbers(command, "--ranks", options.ranks, at_least(1, 1024),
              "Flows: numbers of MPI processes on which each is solved, its times listed; standard: 1");
  command
      .add_option("--neighbour", options.neighbour,
                  "Flows: each is also solved from the flow with this change, e.g. drum.rotation_rpm=5; "
                  "repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_number(command, "--repeats", options.repeats, "", at_least(1, 100),
             "Flows: solves of each, of which the least and the median time are listed");
  add_optional_number(command, "--time-limit", options.time_limit_s, "s", above(0),
                      "Flows: wall time after which one is given up");
  command.add_flag(
      "--effects", options.effects,
      "In place of a sweep: the scene with each of its effects removed and each absent one added; "
      "seconds, unknowns and results of each");
  command
      .add_option(
          "--variants", options.variants,
          "With --effects, flows: which effects together, e.g. inertia,inertia+k; standard: each alone")
      ->delimiter(',')
      ->type_name("LIST");
  command
      .add_option("--against", options.against,
                  "With --effects, flows of a drum: measured runs of its speed; the errors of each variant "
                  "against them")
      ->type_name("RUN...");
  command
      .add_option_function<std::string>(
          "-o,--output", [&options](const std::string& folder) { options.output = folder; },
          "Folder for cost.json, its points and figures; --effects of particles can do without")
      ->type_name("COST");
  add_overrides(command, options.overrides);
  add_number(command, "--seconds", options.seconds, "s", above(0),
             "With --effects, particles: simulated time from the start of the scene");
  add_number(command, "--threads", options.threads, "", at_least(1, most_threads),
             "Threads; the results do not depend on it");
  add_existing(command, options.existing, "Keeps the points that an earlier call has finished");
}

}  // namespace drumlin::apps
