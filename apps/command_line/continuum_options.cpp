// Options of the commands that fit a law, solve the continuum with it, and compare.
#include <CLI/CLI.hpp>

#include "apps/command_line/checked_options.hpp"
#include "apps/command_line/command_options.hpp"

namespace drumlin::apps {

void add_calibrate_options(CLI::App& command, CalibrateOptions& options) {
  command.add_option("runs", options.runs, "Folders of measured runs")->required()->type_name("RUN");
  add_folder_or_file(command, "-o,--output", options.output, "RHEOLOGY.toml", "File for the law");
  command
      .add_option("--validate", options.validate,
                  "Runs that the law is not fitted on: how well it predicts them")
      ->type_name("RUN");
  command
      .add_option("--from", options.from,
                  "The tensors of maps.h5 (stress along the strain rate), or the ratio of profiles.csv at "
                  "the centre")
      ->check(CLI::IsMember({"auto", "maps", "profiles"}))
      ->capture_default_str();
  command.add_option("--law", options.law, "Form of mu(I): a + b ln I, a + b ln I + c I, points")
      ->check(CLI::IsMember({"auto", "log", "log-linear", "table"}))
      ->capture_default_str();
  command.add_flag("--k", options.k, "Ratio of the normal stresses k(I) as a part of the law");
  command.add_flag("--misalignment", options.misalignment,
                   "Angle between the axes of stress and strain rate over I (from maps)");
  CLI::Option* memory = command.add_flag(
      "--memory", options.memory,
      "Memory of the axes of stress as a part of the law: amount of the stress over I, share "
      "renewed by strain, and what the runs cannot tell of them (from maps)");
  CLI::Option* amount =
      command
          .add_flag("--amount", options.amount,
                    "With --memory: what is added to the amount of the stress: creep, dilatancy and lag of "
                    "the axes, as a part of the law")
          ->needs(memory);
  add_number(command, "--own-weight", options.own_weight, "rho0 g d", at_least(0, 100),
             "With --amount: w in the law's I = 2|D|/sqrt(p + w)");
  command.get_option("--own-weight")->needs(amount);
  command.add_flag("--nonlocal", options.nonlocal,
                   "Threshold and length of nonlocal fluidity as a part of the law, and whether the runs ask "
                   "for them (from maps)");
  add_optional_number(command, "--I-min", options.I_min, "", above(0),
                      "Least inertial number that is fitted");
  add_optional_number(command, "--I-max", options.I_max, "", above(0), "Greatest one");
  add_number(command, "--draws", options.draws, "", at_least(16, 10000),
             "Draws of the points for the 99 % band, which fewer than 199 do not hold");
  command.add_flag("--accept-unsteady", options.accept_unsteady,
                   "Takes runs that their measurement does not call steady, and says so");
  add_existing(command, options.existing, keep_what_is_done);
}

void add_flow_options(CLI::App& command, FlowOptions& options) {
  add_scene_file(command, options.scene, "Flow scene");
  add_folder_or_file(command, "--rheology", options.rheology, "RHEOLOGY.toml",
                     "Law, from calibrate or data/rheology");
  add_folder_or_file(command, "-o,--output", options.output, "FLOWRUN", "Folder for the results");
  add_optional_path(command, "--from", options.from, "FLOWRUN",
                    "Finished flow to start from: same geometry and mesh, other speed or law");
  add_number(command, "--law-draws", options.law_draws, "", at_least(0, 16),
             "Solves again with so many of the laws that other draws of the law's points gave: the part of "
             "the result that the law leaves open; 3 at least for a band, 0: none");
  add_overrides(command, options.overrides);
  add_existing(command, options.existing, keep_what_is_done);
}

void add_compare_options(CLI::App& command, CompareOptions& options, CompareStudyOptions& study) {
  command.add_option("run", options.run, "Folder of a measured run (or of a flow): what is compared with")
      ->type_name("RUN");
  command
      .add_option("flow_run", options.flow_run,
                  "Folder of a continuum flow (or of another measured run): what is compared")
      ->type_name("FLOWRUN");
  add_folder_or_file(command, "-o,--output", options.output, "REPORT",
                     "Folder for the report; open its index.html");
  command
      .add_option("--floor", options.floor,
                  "Another run of the same scene, from other random numbers: its errors against RUN are the "
                  "noise floor that appears beside every error")
      ->type_name("RUN2");
  command
      .add_option("--beside", options.beside,
                  "Another flow of the drum, with another law, say: how many targets it meets, and its error "
                  "beside each")
      ->type_name("FLOWRUN2");
  command
      .add_option(
          "--register", options.registration,
          "What lies at the same place: at the same height below the drum's axis (in layers: above the "
          "base of each side), or at the same depth below each side's own surface")
      ->check(CLI::IsMember({"axis", "surface"}))
      ->capture_default_str();
  command.add_flag("--accept-unsteady", options.accept_unsteady,
                   "Takes runs that their measurement does not call steady, and says so in the report");
  add_existing(command, options.existing, keep_what_is_done);
  command
      .add_option("--study", study.folders,
                  "Measured runs and flows of several speeds, in any order, to be compared over the speed "
                  "of rotation instead: slope, depth, decay length, which speed was calibrated and which "
                  "predicted")
      ->type_name("DIR...");
  add_optional_path(command, "--limits", study.limits, "LIMITS.toml",
                    "With --study: limits by which the flows are judged as well, by both registrations, with "
                    "the noise floor between seeds (data/limits/bed.toml)");
}

void add_score_options(CLI::App& command, ScoreOptions& options) {
  command
      .add_option("fields", options.fields,
                  "Folder of a continuum flow; profiles.csv or maps.h5 of one; or another program's fields "
                  "in CSV (docs/formats/score.md)")
      ->required()
      ->type_name("FIELDS");
  command.add_option("--limits", options.limits, "Limits, as data/limits/bed.toml")
      ->required()
      ->type_name("LIMITS.toml");
  command
      .add_option("--against", options.against,
                  "Measured runs of that drum at that speed; those of data/bed unless told")
      ->type_name("RUN...");
  add_folder_or_file(command, "-o,--output", options.output, "SCORE", "Folder for score.json and score.md");
  add_existing(command, options.existing, keep_what_is_done);
}

}  // namespace drumlin::apps
