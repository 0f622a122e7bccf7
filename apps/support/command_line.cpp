#include "apps/support/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <sstream>

#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/key_spec.hpp"
#include "coupling/exchange/provenance.hpp"

namespace drumlin::apps {

namespace {

/// A number within its range, as text of the command line.
template <class T>
CLI::Validator within(const Allowed& allowed) {
  const std::string range = allowed_text("number", allowed);
  return CLI::Validator(
      [allowed, range](std::string& text) {
        T number{};
        const bool read = CLI::detail::lexical_cast(text, number);
        return read && allowed.holds(static_cast<double>(number)) ? std::string() : text + " is not " + range;
      },
      "");
}

/// A number with its unit and range in the help, and held to that range.
template <class T>
void add_number(CLI::App& command, const std::string& name, T& target, const std::string& unit,
                const Allowed& allowed, const std::string& sentence) {
  const std::string range = allowed_text("number", allowed);
  command
      .add_option(name, target, fmt::format("{} [{}{}]", sentence, unit.empty() ? "" : unit + ", ", range))
      ->capture_default_str()
      ->check(within<T>(allowed));
}

/// A number that may be left out.
void add_optional_number(CLI::App& command, const std::string& name, std::optional<double>& target,
                         const Allowed& allowed, const std::string& sentence) {
  command
      .add_option_function<double>(
          name, [&target](const double& number) { target = number; },
          fmt::format("{} [{}]", sentence, allowed_text("number", allowed)))
      ->check(within<double>(allowed));
}

void add_folder_or_file(CLI::App& command, const std::string& name, std::filesystem::path& target,
                        const std::string& kind, const std::string& sentence) {
  command.add_option(name, target, sentence)->required()->type_name(kind);
}

/// A path that may be left out.
void add_optional_path(CLI::App& command, const std::string& name,
                       std::optional<std::filesystem::path>& target, const std::string& kind,
                       const std::string& sentence) {
  command
      .add_option_function<std::string>(
          name, [&target](const std::string& path) { target = path; }, sentence)
      ->type_name(kind);
}

void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  command
      .add_option("--set", overrides,
                  "Changes one key of the file, e.g. --set solver.max_sweeps=50 or --set stages.1.turns=2; "
                  "repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

/// --resume and --overwrite; without either an existing output is refused.
void add_existing(CLI::App& command, ExistingOutput& existing, const std::string& resume_sentence) {
  auto* resume = command.add_flag_callback(
      "--resume", [&existing] { existing = ExistingOutput::resume; }, resume_sentence);
  auto* overwrite = command.add_flag_callback(
      "--overwrite", [&existing] { existing = ExistingOutput::overwrite; },
      "Replaces what an earlier call left");
  resume->excludes(overwrite);
  overwrite->excludes(resume);
}

void add_accuracy(CLI::App& command, std::optional<std::filesystem::path>& accuracy) {
  add_optional_path(
      command, "--accuracy", accuracy, "COST",
      "Left by drumlin cost --statistics for the same scene: from it comes what solver tolerance and "
      "time step leave of error; standard: a record of data/cost, if one is of the scene");
}

const char* const keep_what_is_done = "Keeps what an earlier call has finished";

/// All commands with the options that they fill in; `request` receives those of the chosen one.
class CommandLine {
 public:
  explicit CommandLine(const std::vector<std::string>& solvers)
      : app_("Drumlin: dense granular flow, grains and continuum") {
    app_.name("drumlin");
    app_.set_version_flag("--version", version());
    app_.require_subcommand(1);
    app_.footer(
        "Exit codes: 0 done, 2 wrong usage or input, 3 not converged, 74 input/output, 130 interrupted, 143 "
        "terminated.\n"
        "Each command has its own --help.");
    add_run();
    add_measure();
    add_import();
    add_plot();
    add_export();
    add_calibrate();
    add_flow();
    add_compare();
    add_scene();
    add_solve_contacts(solvers);
    add_cost();
    add_hardcases();
  }

  Request parse(int argc, const char* const* argv) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      std::ostringstream shown, fault;
      if (app_.exit(error, shown, fault) == 0) return TextToShow{shown.str()};
      std::string text = fault.str();
      while (!text.empty() && text.back() == '\n') text.pop_back();
      throw InputError(text);
    }
    return request_();
  }

 private:
  static std::string version() {
    const Provenance p = provenance();
    return fmt::format("drumlin {} ({}, {})", p.revision, p.compiler, p.build_type);
  }

  template <class Options>
  CLI::App& add_command(const std::string& name, const std::string& sentence, const Options& options) {
    CLI::App* command = app_.add_subcommand(name, sentence);
    command->callback([this, &options] { request_ = [&options]() -> Request { return options; }; });
    return *command;
  }

  void add_run() {
    CLI::App& command = add_command("run", "Runs a particle scene", run_);
    add_folder_or_file(command, "scene", run_.scene, "SCENE.toml", "Scene file (docs/formats/scene.md)");
    add_folder_or_file(command, "-o,--output", run_.output, "RUN", "Folder for the results");
    add_overrides(command, run_.overrides);
    add_number(command, "--threads", run_.threads, "", at_least(1, 1024),
               "Threads; the results do not depend on it");
    add_accuracy(command, run_.accuracy);
    add_existing(command, run_.existing, "Continues from the last checkpoint; starts over if there is none");
  }

  void add_measure() {
    CLI::App& command = add_command("measure", "Profiles and scalars of a run, into RUN/measured", measure_);
    command.add_option("run", measure_.run, "Folder of a finished run")->type_name("RUN");
    add_study(command);
    add_number(command, "--slice-width", measure_.slice_width, "d", above(0),
               "Width of the slice, across its middle");
    add_number(command, "--layer-thickness", measure_.layer_thickness, "d", above(0),
               "Thickness of the layers");
    add_number(command, "--position", measure_.position, "d", anything(),
               "Place of the slice along the surface, from the middle of the drum, positive downslope");
    command
        .add_option(
            "--parts", measure_.parts,
            "What is measured beside the profiles, the rest is neither computed nor stored; none: nothing "
            "[all of gradients, slices, sensitivity, voronoi, forces, maps]")
        ->delimiter(',')
        ->type_name("LIST");
    add_number(command, "--gradient-step", measure_.gradient_step, "d", above(0),
               "Derivatives along x from slices this far to either side");
    command.add_option("--slices", measure_.slices, "Places of the narrow slices along the surface, d")
        ->delimiter(',')
        ->type_name("X,X,...");
    add_number(command, "--map-spacing", measure_.map_spacing, "d", above(0),
               "Distance of the nodes of the maps");
    add_number(command, "--map-width", measure_.map_width, "d", above(0),
               "Width of their kernel, 1 to 15 times the distance of the nodes");
    command
        .add_option(
            "--grains", measure_.grains,
            "Snapshots of which every grain's fields are written: all, last, or numbers and ranges such as "
            "1,5,10-20")
        ->type_name("LIST");
    add_accuracy(command, measure_.accuracy);
    add_existing(command, measure_.existing, keep_what_is_done);
  }

  /// Either one run is measured, or measured ones are studied together.
  void add_study(CLI::App& command) {
    command
        .add_option(
            "--study", study_.runs,
            "Measured runs to be studied together instead: laws over the speed of rotation, the paper's "
            "table, figures")
        ->type_name("RUN...");
    command.add_option("-o,--output", study_.output, "Folder for the study; open its index.html")
        ->type_name("STUDY");
    command.callback([this] {
      if (study_.runs.empty() == measure_.run.empty())
        throw CLI::RequiredError("one of RUN and --study RUN...");
      if (study_.runs.empty() != study_.output.empty())
        throw CLI::RequiredError("--study RUN... together with --output STUDY");
      study_.existing = measure_.existing;
      request_ = [this]() -> Request {
        if (study_.runs.empty()) return measure_;
        return study_;
      };
    });
  }

  void add_import() {
    CLI::App& command = add_command(
        "import", "Makes a run folder of another program's snapshots (CSV, LAMMPS dumps)", import_);
    add_optional_path(command, "description", import_.description, "DESCRIPTION.toml",
                      "What the files are (docs/formats/import.md)");
    add_optional_path(command, "-o,--output", import_.output, "RUN", "Folder for the snapshots");
    add_overrides(command, import_.overrides);
    command.add_flag("--keys", import_.keys,
                     "Lists every key of a description with unit, range, default and meaning");
    command.add_flag("--markdown", import_.markdown, "With --keys: as the table of docs/formats/import.md");
    add_existing(command, import_.existing, keep_what_is_done);
  }

  void add_plot() {
    CLI::App& command = add_command("plot", "Draws a run: grains, force chains, accuracy and cost", plot_);
    add_folder_or_file(command, "run", plot_.run, "RUN", "Folder of a run, finished or not");
    command.add_option("--snapshot", plot_.snapshot, "Which snapshot is drawn: its number, or last")
        ->type_name("N")
        ->capture_default_str();
    command.add_flag("--animation", plot_.animation, "Draws the snapshots as an animated GIF as well");
    add_optional_path(command, "-o,--output", plot_.output, "DIR",
                      "Folder for the figures; standard: RUN/plots");
    add_existing(command, plot_.existing, keep_what_is_done);
  }

  void add_export() {
    CLI::App& command = add_command("export", "Writes a run in a format of other programs", export_);
    add_folder_or_file(command, "run", export_.run, "RUN", "Folder of a run, finished or not");
    command.add_flag("--vtu", export_.vtu, "VTK files with grains, contacts and walls, for ParaView")
        ->required();
    command
        .add_option("--snapshots", export_.snapshots,
                    "Which snapshots: all, last, or numbers and ranges such as 1,5,10-20")
        ->type_name("LIST")
        ->capture_default_str();
    add_optional_path(command, "-o,--output", export_.output, "DIR",
                      "Folder for the files; standard: RUN/vtu");
    add_existing(command, export_.existing, keep_what_is_done);
  }

  void add_calibrate() {
    CLI::App& command =
        add_command("calibrate", "Fits mu(I), and k(I) on request, to measured runs", calibrate_);
    command.add_option("runs", calibrate_.runs, "Folders of measured runs")->required()->type_name("RUN");
    add_folder_or_file(command, "-o,--output", calibrate_.output, "RHEOLOGY.toml", "File for the law");
    command
        .add_option("--validate", calibrate_.validate,
                    "Runs that the law is not fitted on: how well it predicts them")
        ->type_name("RUN");
    command
        .add_option("--from", calibrate_.from,
                    "The tensors of maps.h5 (stress along the strain rate), or the ratio of profiles.csv at "
                    "the centre")
        ->check(CLI::IsMember({"auto", "maps", "profiles"}))
        ->capture_default_str();
    command.add_option("--law", calibrate_.law, "Form of mu(I): a + b ln I, a + b ln I + c I, points")
        ->check(CLI::IsMember({"auto", "log", "log-linear", "table"}))
        ->capture_default_str();
    command.add_flag("--k", calibrate_.k, "Ratio of the normal stresses k(I) as a part of the law");
    command.add_flag("--misalignment", calibrate_.misalignment,
                     "Angle between the axes of stress and strain rate over I (from maps)");
    command.add_flag("--relaxation", calibrate_.relaxation,
                     "Share of its fabric that the material renews per unit of shear (from maps)");
    add_optional_number(command, "--I-min", calibrate_.I_min, above(0),
                        "Least inertial number that is fitted");
    add_optional_number(command, "--I-max", calibrate_.I_max, above(0), "Greatest one");
    add_number(command, "--draws", calibrate_.draws, "", at_least(16, 10000),
               "Draws of the points for the 99 % band");
    command.add_flag("--accept-unsteady", calibrate_.accept_unsteady,
                     "Takes runs that their measurement does not call steady, and says so");
    add_existing(command, calibrate_.existing, keep_what_is_done);
  }

  void add_flow() {
    CLI::App& command =
        add_command("flow", "Solves the continuum flow with a law (starts drumlin-flow)", flow_);
    add_folder_or_file(command, "scene", flow_.scene, "FLOW.toml", "Flow scene (docs/formats)");
    add_folder_or_file(command, "--rheology", flow_.rheology, "RHEOLOGY.toml",
                       "Law, from calibrate or data/rheology");
    add_folder_or_file(command, "-o,--output", flow_.output, "FLOWRUN", "Folder for the results");
    add_optional_path(command, "--from", flow_.from, "FLOWRUN",
                      "Finished flow to start from: same geometry and mesh, other speed or law");
    add_number(command, "--law-draws", flow_.law_draws, "", at_least(0, 16),
               "Solves again with so many of the laws that other draws of the law's points gave: the part of "
               "the result that the law leaves open; 3 at least for a band, 0: none");
    add_overrides(command, flow_.overrides);
    add_existing(command, flow_.existing, keep_what_is_done);
  }

  void add_compare() {
    CLI::App& command = add_command("compare", "Sets a run and a continuum flow side by side", compare_);
    command.add_option("run", compare_.run, "Folder of a measured run (or of a flow): what is compared with")
        ->type_name("RUN");
    command
        .add_option("flow_run", compare_.flow_run,
                    "Folder of a continuum flow (or of another measured run): what is judged")
        ->type_name("FLOWRUN");
    add_folder_or_file(command, "-o,--output", compare_.output, "REPORT",
                       "Folder for the report; open its index.html");
    command
        .add_option("--floor", compare_.floor,
                    "Another run of the same drum, from other random numbers: its errors against RUN are the "
                    "noise floor that stands beside every error")
        ->type_name("RUN2");
    command
        .add_option("--register", compare_.registration,
                    "What lies at the same place: at the same height below the drum's axis, or at the same "
                    "depth below each side's own surface")
        ->check(CLI::IsMember({"axis", "surface"}))
        ->capture_default_str();
    command.add_flag("--accept-unsteady", compare_.accept_unsteady,
                     "Takes runs that their measurement does not call steady, and says so in the report");
    add_existing(command, compare_.existing, keep_what_is_done);
    add_compare_study(command);
  }

  /// Either a pair is compared, or all speeds of both sides are.
  void add_compare_study(CLI::App& command) {
    command
        .add_option("--study", compare_study_.folders,
                    "Measured runs and flows of several speeds, in any order, to be compared over the speed "
                    "of rotation instead: slope, depth, decay length, which speed was calibrated and which "
                    "predicted")
        ->type_name("DIR...");
    command.callback([this] {
      const bool is_study = !compare_study_.folders.empty();
      const bool is_pair = !compare_.run.empty() && !compare_.flow_run.empty();
      if (is_study ? !compare_.run.empty() : !is_pair)
        throw CLI::RequiredError("either RUN and FLOWRUN, or --study DIR...,");
      compare_study_.output = compare_.output;
      compare_study_.existing = compare_.existing;
      request_ = [this]() -> Request {
        if (compare_study_.folders.empty()) return compare_;
        return compare_study_;
      };
    });
  }

  void add_scene() {
    CLI::App* scene = app_.add_subcommand("scene", "Checks, shows and explains scene files");
    scene->require_subcommand(1);
    const auto add_action = [&](const std::string& name, SceneAction action, const std::string& sentence) {
      CLI::App* command = scene->add_subcommand(name, sentence);
      command->callback([this, action] {
        scene_.action = action;
        request_ = [this]() -> Request { return scene_; };
      });
      return command;
    };
    for (auto [name, action, sentence] :
         {std::tuple("check", SceneAction::check, "Validates a scene and says what it amounts to"),
          std::tuple("show", SceneAction::show, "Prints a scene with all its defaults")}) {
      CLI::App* command = add_action(name, action, sentence);
      add_folder_or_file(*command, "scene", scene_.scene, "SCENE.toml", "Scene file");
      add_overrides(*command, scene_.overrides);
    }
    CLI::App* keys =
        add_action("keys", SceneAction::keys, "Lists every key with unit, range, default and meaning");
    keys->add_flag("--markdown", scene_.markdown, "As the table of docs/formats/scene.md");
  }

  void add_solve_contacts(const std::vector<std::string>& solvers) {
    CLI::App& command =
        add_command("solve-contacts", "Solves one contact problem from a file", solve_contacts_);
    add_folder_or_file(command, "problem", solve_contacts_.problem, "PROBLEM.h5",
                       "Problem in FCLIB's fclib_local layout, spacedim 2");
    command.add_option("--solver", solve_contacts_.solver, "Contact solver")
        ->capture_default_str()
        ->check(CLI::IsMember(solvers));
    add_number(command, "--tolerance", solve_contacts_.tolerance, "", above(0, 10),
               "It may stop below this residual (docs/conventions.md)");
    add_number(command, "--max-seconds", solve_contacts_.max_seconds, "s", above(0),
               "It stops after this wall time in any case");
    command
        .add_option_function<std::string>(
            "--output", [this](const std::string& file) { solve_contacts_.output = file; },
            "File for the solution, r and u under /solution; none is written without")
        ->type_name("SOL.h5");
    command.add_flag("--json", solve_contacts_.json,
                     "Prints status, residual, residual_max, sweeps, seconds as JSON");
  }

  void add_cost() {
    CLI::App& command =
        add_command("cost", "What accuracy costs in a scene, or its effects (docs/cost.md)", cost_);
    add_folder_or_file(command, "scene", cost_.scene, "SCENE.toml", "Scene of particles or of a flow");
    command
        .add_option("--sweep", cost_.sweep,
                    "What is varied, each with its values or standard ones, e.g. tolerance=1e-2:1e-3,step; "
                    "particles: solver, tolerance, step; flows: mesh, eps, tolerance [all]")
        ->delimiter(',')
        ->type_name("NAME[=VALUE:...],...");
    command
        .add_option_function<double>(
            "--horizon", [this](double seconds) { cost_.horizon_s = seconds; },
            "Particles: longest stretch after which velocities are compared; half or a quarter of it where "
            "the "
            "finest point leaves the reference earlier; standard: 16 steps of the scene [s, number > 0]")
        ->check(CLI::PositiveNumber);
    command
        .add_option_function<double>(
            "--statistics", [this](double seconds) { cost_.statistics_s = seconds; },
            "Particles: compares the measured numbers of runs of this length as well [s, number > 0]")
        ->check(CLI::PositiveNumber);
    add_optional_path(
        command, "--from", cost_.from, "RUN",
        "Particles: finished run of the scene to start from; standard: the beginning of the last "
        "stage, which is run up to first");
    add_optional_path(command, "--rheology", cost_.rheology, "RHEOLOGY.toml",
                      "Flows: law, from calibrate or data/rheology");
    command.add_flag(
        "--effects", cost_.effects,
        "In place of a sweep: the scene with each of its effects removed and each absent one added; "
        "seconds, unknowns and results of each");
    command
        .add_option_function<std::string>(
            "-o,--output", [this](const std::string& folder) { cost_.output = folder; },
            "Folder for cost.json, its points and figures; --effects of particles can do without")
        ->type_name("COST");
    add_overrides(command, cost_.overrides);
    add_number(command, "--seconds", cost_.seconds, "s", above(0),
               "With --effects, particles: simulated time from the start of the scene");
    add_number(command, "--threads", cost_.threads, "", at_least(1, 1024),
               "Threads; the results do not depend on it");
    add_existing(command, cost_.existing, "Keeps the points that an earlier call has finished");
  }

  void add_hardcases() {
    CLI::App& command = add_command(
        "hardcases", "Runs cases with known outcomes through the engine (docs/hard-cases.md)", hardcases_);
    command.add_option("names", hardcases_.names, "Cases; all of them if none is named")->type_name("NAME");
    command.add_flag("--fast", hardcases_.fast,
                     "Only those that are part of ./check: quick, and known to hold");
    command
        .add_option_function<std::string>(
            "-o,--output", [this](const std::string& folder) { hardcases_.output = folder; },
            "Folder for hardcases.json; none is written without")
        ->type_name("DIR");
    command.add_flag_callback(
        "--overwrite", [this] { hardcases_.existing = ExistingOutput::overwrite; },
        "Replaces what an earlier call left");
  }

  CLI::App app_;
  RunOptions run_;
  MeasureOptions measure_;
  ImportOptions import_;
  StudyOptions study_;
  PlotOptions plot_;
  ExportOptions export_;
  CalibrateOptions calibrate_;
  FlowOptions flow_;
  CompareOptions compare_;
  CompareStudyOptions compare_study_;
  SceneOptions scene_;
  SolveContactsOptions solve_contacts_;
  CostOptions cost_;
  HardcasesOptions hardcases_;
  std::function<Request()> request_;
};

}  // namespace

Request parse_command_line(int argc, const char* const* argv, const std::vector<std::string>& solvers) {
  return CommandLine(solvers).parse(argc, argv);
}

}  // namespace drumlin::apps
