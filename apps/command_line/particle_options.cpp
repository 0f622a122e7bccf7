// Options of the commands that run grains and look at their runs.
#include <CLI/CLI.hpp>

#include "apps/command_line/checked_options.hpp"
#include "apps/command_line/command_options.hpp"

namespace drumlin::apps {

void add_run_options(CLI::App& command, RunOptions& options) {
  add_scene_file(command, options.scene, "Scene file");
  add_folder_or_file(command, "-o,--output", options.output, "RUN", "Folder for the results");
  add_overrides(command, options.overrides);
  add_number(command, "--threads", options.threads, "", at_least(1, most_threads),
             "Threads, all processors unless told; the results do not depend on it");
  command
      .add_option("--ranks", options.ranks,
                  "Runs on so many MPI ranks of this machine, each with its share of the threads (starts "
                  "drumlin-run); "
                  "the results do not depend on how many (docs/scaling.md)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  add_accuracy(command, options.accuracy);
  add_number(
      command, "--accuracy-seconds", options.accuracy_seconds, "s", above(0),
      "Ends with stretches of so many simulated seconds: as the scene is, with half the time step and with a "
      "third of the tolerance; what they differ by tells the errors of the run (docs/cost.md)");
  add_number(command, "--extend", options.extend_seconds, "s", above(0),
             "Prolongs the last stage of the finished run in RUN, whose scene is RUN/scene.toml, by so many "
             "simulated seconds, in whole intervals of its snapshots");
  add_existing(command, options.existing, "Continues from the last checkpoint; starts over if there is none");
}

void add_measure_options(CLI::App& command, MeasureOptions& options, StudyOptions& study) {
  command.add_option("run", options.run, "Folder of a finished run")->type_name("RUN");
  command
      .add_option(
          "--study", study.runs,
          "Measured runs to be studied together instead: laws over the speed of rotation, the paper's "
          "table, figures")
      ->type_name("RUN...");
  command.add_option("-o,--output", study.output, "Folder for the study; open its index.html")
      ->type_name("STUDY");
  add_number(command, "--slice-width", options.slice_width, "d", above(0),
             "Width of the slice, across its middle");
  add_number(command, "--layer-thickness", options.layer_thickness, "d", at_least(1e-3),
             "Thickness of the layers");
  add_number(command, "--position", options.position, "d", anything(),
             "Place of the slice along the surface, from the middle of the drum, positive downslope");
  command
      .add_option(
          "--parts", options.parts,
          "What is measured beside the profiles, the rest is neither computed nor stored; none: nothing "
          "[all of gradients, slices, sensitivity, voronoi, forces, maps]")
      ->delimiter(',')
      ->type_name("LIST");
  add_number(command, "--gradient-step", options.gradient_step, "d", above(0),
             "Derivatives along x from slices this far to either side");
  command
      .add_option("--slices", options.slices,
                  "Places of the narrow slices along the surface, d, at least 0.1 apart")
      ->delimiter(',')
      ->type_name("X,X,...");
  add_number(command, "--map-spacing", options.map_spacing, "d", above(0),
             "Distance of the nodes of the maps");
  add_number(command, "--map-width", options.map_width, "d", above(0),
             "Width of their kernel, 1 to 15 times the distance of the nodes");
  command
      .add_option(
          "--grains", options.grains,
          "Snapshots of which every grain's fields are written: all, last, or numbers and ranges such as "
          "1,5,10-20")
      ->type_name("LIST");
  command
      .add_option("--radial", options.radial,
                  "Profiles over the distance from a point as well, in d and the axes of the scene, or from "
                  "the axis of the circular wall: axis")
      ->delimiter(',')
      ->type_name("X,Z");
  command
      .add_option("--height", options.height,
                  "Profiles over the height as well, within a band of x in d: a silo's axis")
      ->delimiter(',')
      ->type_name("X0,X1");
  command
      .add_option("--width", options.width,
                  "Profiles over the width as well, within a band of z in d: a silo at one height")
      ->delimiter(',')
      ->type_name("Z0,Z1");
  command.add_flag("--verbose", options.verbose, "Prints every number, not the main ones alone");
  add_accuracy(command, options.accuracy);
  add_existing(command, options.existing, keep_what_is_done);
}

void add_import_options(CLI::App& command, ImportOptions& options) {
  add_optional_path(command, "description", options.description, "DESCRIPTION.toml",
                    "What the files are (docs/formats/import.md)");
  add_optional_path(command, "-o,--output", options.output, "RUN", "Folder for the snapshots");
  add_overrides(command, options.overrides);
  command.add_flag("--keys", options.keys,
                   "Lists every key of a description with unit, range, default and meaning");
  command.add_flag("--markdown", options.markdown, "With --keys: as a table in Markdown");
  add_existing(command, options.existing, keep_what_is_done);
}

void add_plot_options(CLI::App& command, PlotOptions& options) {
  add_folder_or_file(command, "run", options.run, "RUN", "Folder of a run, finished or not");
  command.add_option("--snapshot", options.snapshot, "Which snapshot is drawn: its number, or last")
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--animation", options.animation, "Draws the snapshots as an animated GIF as well");
  command.add_flag("--player", options.player,
                   "Writes player.html as well: one file in which the run plays, in any browser");
  add_number(command, "--every", options.every, "", at_least(1, 1000000),
             "Every N-th snapshot is a frame of the animation and of the player; without these each of "
             "them is a still of its own");
  command
      .add_option("--color", options.color,
                  "What the colour of a grain shows; absent: speed, and a second picture of the spin")
      ->check(CLI::IsMember(std::vector<std::string>(plot_colors.begin(), plot_colors.end())))
      ->type_name("WHAT");
  command
      .add_option("--window", options.window,
                  "Part of the plane that is shown, in d, in the axes of the scene; absent: all grains")
      ->delimiter(',')
      ->type_name("X0,X1,Z0,Z1");
  add_optional_path(command, "-o,--output", options.output, "DIR",
                    "Folder for the figures; standard: RUN/plots");
  add_existing(command, options.existing, keep_what_is_done);
}

void add_report_options(CLI::App& command, ReportOptions& options) {
  add_folder_or_file(command, "run", options.run, "RUN", "Folder of a run, finished or not, measured or not");
  add_optional_path(command, "-o,--output", options.output, "DIR",
                    "Folder for the page, open its index.html; standard: RUN/report");
  add_optional_path(command, "--bundle", options.bundle, "FILE.tar.gz",
                    "In place of a page: scene, log and versions in one small file, for a report of a fault");
  add_existing(command, options.existing, keep_what_is_done);
}

void add_new_scene_options(CLI::App& command, NewSceneOptions& options) {
  command.add_option("kind", options.kind, "What flows")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>(scene_kinds.begin(), scene_kinds.end())))
      ->type_name("KIND");
  add_folder_or_file(command, "-o,--output", options.output, "SCENE.toml", "File for the scene");
  command.add_flag_callback(
      "--overwrite", [&options] { options.existing = ExistingOutput::overwrite; },
      "Replaces a file that is there");
}

void add_export_options(CLI::App& command, ExportOptions& options) {
  add_folder_or_file(command, "run", options.run, "RUN", "Folder of a run, finished or not");
  auto* vtu =
      command.add_flag("--vtu", options.vtu, "VTK files with grains, contacts and walls, for ParaView");
  auto* measurements = command.add_flag(
      "--measurements", options.measurements,
      "What was measured, without snapshots and figures and with packed maps: what calibrate, compare and "
      "measure --study read in the place of the run");
  vtu->excludes(measurements);
  command
      .add_option("--snapshots", options.snapshots,
                  "Which snapshots: all, last, or numbers and ranges such as 1,5,10-20")
      ->type_name("LIST")
      ->capture_default_str();
  add_optional_path(command, "-o,--output", options.output, "DIR",
                    "Folder for the files; standard with --vtu: RUN/vtu");
  add_existing(command, options.existing, keep_what_is_done);
}

void add_history_options(CLI::App& command, HistoryOptions& options) {
  add_folder_or_file(command, "run", options.run, "RUN", "Folder of a run, finished or not");
  command
      .add_option(
          "--box", options.box,
          "Region whose mean stress, fabric and strain are written, in d, in the axes of the scene; absent: "
          "the walls alone")
      ->delimiter(',')
      ->type_name("X_MIN,X_MAX,Z_MIN,Z_MAX");
  add_number(command, "--sectors", options.sectors, "", at_least(1, 10000),
             "Sectors of a circular container in which its tractions are averaged");
  add_optional_path(command, "-o,--output", options.output, "DIR",
                    "Folder for the tables; standard: RUN/history");
  add_existing(command, options.existing, keep_what_is_done);
}

void add_accept_options(CLI::App& command, AcceptOptions& options) {
  add_folder_or_file(command, "folder", options.folder, "DIR", "Result folder of any command");
  command.add_option("--reason", options.reason, "Why, in one line: it is told wherever the folder is read")
      ->required()
      ->type_name("TEXT");
}

void add_solve_contacts_options(CLI::App& command, SolveContactsOptions& options,
                                const std::vector<std::string>& solvers) {
  add_folder_or_file(command, "problem", options.problem, "PROBLEM.h5",
                     "Problem in FCLIB's fclib_local layout, spacedim 2");
  command.add_option("--solver", options.solver, "Contact solver")
      ->capture_default_str()
      ->check(CLI::IsMember(solvers));
  add_number(command, "--tolerance", options.tolerance, "", above(0, 10),
             "It may stop below this residual (docs/conventions.md)");
  add_number(command, "--max-seconds", options.max_seconds, "s", above(0),
             "It stops after this wall time in any case");
  add_number(command, "--threads", options.threads, "", at_least(1, most_threads),
             "Threads, of solvers that know them and W of discs; the impulses do not depend on it");
  command
      .add_option_function<std::string>(
          "--output", [&options](const std::string& file) { options.output = file; },
          "File for the solution, r, u, state and error under /solution; none is written without")
      ->type_name("SOL.h5");
  command.add_flag_callback(
      "--overwrite", [&options] { options.existing = ExistingOutput::overwrite; },
      "Replaces a file of that name");
  command.add_flag("--backward-error", options.backward_error,
                   "Says how far the problem that the solution solves exactly is from this one");
  command
      .add_option_function<int>(
          "--watch", [&options](const int sweeps) { options.watch = sweeps; },
          "Sweeps on so many times from the solution and counts which contacts change their state")
      ->type_name("SWEEPS")
      ->check(CLI::Range(1, 1000000));
  command.add_flag("--json", options.json, "Prints status, residual, residual_max, sweeps, seconds as JSON");
}

}  // namespace drumlin::apps
