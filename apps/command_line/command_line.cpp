#include "apps/command_line/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <utility>

#include "apps/command_line/checked_options.hpp"
#include "apps/command_line/command_options.hpp"
#include "apps/command_line/completion.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/provenance.hpp"

namespace drumlin::apps {

namespace {

/// A link to a folder that a user names for results stands for that folder; no other link is followed.
std::string linked_folder(const std::string& name) {
  const std::filesystem::path given = name, link = given.has_filename() ? given : given.parent_path();
  std::error_code error;
  const bool is_link = is_symlink(symlink_status(link, error)) && is_directory(link, error);
  return is_link ? std::filesystem::canonical(link).string() : name;
}

/// Names stand in results, whose text is UTF-8.
void refuse_unless_utf8(const std::string& word) {
  try {
    (void)nlohmann::json(word).dump();
  } catch (const nlohmann::json::type_error&) {
    throw InputError(word + ": is no UTF-8; name files and folders in it");
  }
}

/// Letters to add, leave out or replace that make one word of the other (Levenshtein).
std::size_t edits(const std::string& from, const std::string& to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t k = 1; k <= from.size(); ++k) {
    std::size_t diagonal = std::exchange(row[0], k);
    for (std::size_t m = 1; m <= to.size(); ++m) {
      const std::size_t replaced = diagonal + (from[k - 1] != to[m - 1]);
      diagonal = std::exchange(row[m], std::min({row[m] + 1, row[m - 1] + 1, replaced}));
    }
  }
  return row.back();
}

/// All commands with the options that they fill in; `request` receives those of the chosen one.
class CommandLine {
 public:
  explicit CommandLine(const std::vector<std::string>& solvers)
      : app_("Drumlin: dense granular flow, grains and continuum") {
    app_.name("drumlin");
    app_.set_version_flag("--version", "drumlin " + version_text());
    app_.add_option_function<std::string>(
            "--completion",
            [this](const std::string& shell) {
              throw CLI::CallForVersion(shell == "bash"  ? bash_completion(app_)
                                        : shell == "zsh" ? zsh_completion(app_)
                                                         : fish_completion(app_),
                                        0);
            },
            "Prints a script that completes commands and options: source <(drumlin --completion bash)")
        ->check(CLI::IsMember({"bash", "zsh", "fish"}))
        ->type_name("SHELL");
    app_.add_flag_callback(
        "--man", [this] { throw CLI::CallForVersion(man_page(app_), 0); },
        "Prints a page for man: man -l <(drumlin --man)");
    app_.require_subcommand(1);
    app_.footer(
        "New here: drumlin new drum -o scene.toml, and docs/tutorial.md.\n"
        "Exit codes: 0 done, 2 wrong usage or input, 3 not converged, 70 a fault of this program, "
        "74 input/output, 129 hung up, 130 interrupted, 143 terminated.\n"
        "Each command has its own --help.");
    add_new_scene_options(add_command("new", "Writes a commented scene to start from", new_scene_),
                          new_scene_);
    add_run_options(add_command("run", "Runs a particle scene", run_), run_);
    add_measure();
    add_import_options(
        add_command("import", "Makes a run folder of another program's snapshots (CSV, LAMMPS dumps)",
                    import_),
        import_);
    add_plot_options(add_command("plot", "Draws a run: grains, force chains, accuracy and cost", plot_),
                     plot_);
    add_report_options(add_command("report", "Puts a run on one page, with a player", report_), report_);
    add_export_options(add_command("export", "Writes a run in a format of other programs", export_), export_);
    add_history_options(
        add_command(
            "history",
            "Stress and strain of a region, forces on walls, angle of the surface, snapshot by snapshot",
            history_),
        history_);
    add_calibrate_options(
        add_command("calibrate", "Fits mu(I), and k(I) on request, to measured runs", calibrate_),
        calibrate_);
    add_flow_options(add_command("flow", "Solves the continuum flow with a law (starts drumlin-flow)", flow_),
                     flow_);
    add_compare();
    add_score_options(
        add_command("score", "Errors of any continuum of a drum against the particles, beside their limits",
                    score_),
        score_);
    add_scene();
    add_solve_contacts_options(
        add_command("solve-contacts", "Solves one contact problem from a file", solve_contacts_),
        solve_contacts_, solvers);
    add_cost_options(
        add_command("cost", "What accuracy costs in a scene, or its effects (docs/cost.md)", cost_), cost_);
    add_accept_options(add_command("accept", "Takes a result folder as it is after an edit by hand", accept_),
                       accept_);
    for (CLI::App* command : app_.get_subcommands({}))
      if (CLI::Option* output = command->get_option_no_throw("--output")) output->transform(linked_folder);
  }

  Request parse(int argc, const char* const* argv) {
    if (argc > 1) refuse_unknown_command(argv[1]);
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
  void refuse_unknown_command(const std::string& word) const {
    if (word.starts_with("-")) return;
    std::string nearest;
    for (const CLI::App* command : commands_of(app_)) {
      if (command->get_name() == word) return;
      if (nearest.empty() || edits(word, command->get_name()) < edits(word, nearest))
        nearest = command->get_name();
    }
    const bool near = edits(word, nearest) <= 1 + word.size() / 3;
    throw InputError("no command is called \"" + word + "\"" +
                     (near ? "; did you mean drumlin " + nearest + "?" : "; drumlin --help lists them"));
  }

  template <class Options>
  CLI::App& add_command(const std::string& name, const std::string& sentence, const Options& options) {
    CLI::App* command = app_.add_subcommand(name, sentence);
    command->callback([this, &options] { request_ = [&options]() -> Request { return options; }; });
    return *command;
  }

  /// Either one run is measured, or measured ones are studied together.
  void add_measure() {
    CLI::App& command = add_command("measure", "Profiles and scalars of a run, into RUN/measured", measure_);
    add_measure_options(command, measure_, study_);
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

  /// Either a pair is compared, or all speeds of both sides are.
  void add_compare() {
    CLI::App& command = add_command("compare", "Sets a run and a continuum flow side by side", compare_);
    add_compare_options(command, compare_, compare_study_);
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
      add_scene_file(*command, scene_.scene, "Scene file");
      add_overrides(*command, scene_.overrides);
    }
    add_action("list", SceneAction::list,
               "Lists the shipped scenes, which every command finds by their names");
    CLI::App* keys =
        add_action("keys", SceneAction::keys, "Lists every key with unit, range, default and meaning");
    keys->add_flag("--markdown", scene_.markdown, "As a table in Markdown");
  }

  CLI::App app_;
  RunOptions run_;
  MeasureOptions measure_;
  ImportOptions import_;
  StudyOptions study_;
  PlotOptions plot_;
  ReportOptions report_;
  NewSceneOptions new_scene_;
  ExportOptions export_;
  HistoryOptions history_;
  CalibrateOptions calibrate_;
  FlowOptions flow_;
  CompareOptions compare_;
  CompareStudyOptions compare_study_;
  ScoreOptions score_;
  SceneOptions scene_;
  SolveContactsOptions solve_contacts_;
  CostOptions cost_;
  AcceptOptions accept_;
  std::function<Request()> request_;
};

}  // namespace

Request parse_command_line(int argc, const char* const* argv, const std::vector<std::string>& solvers) {
  for (int k = 1; k < argc; ++k) refuse_unless_utf8(argv[k]);
  return CommandLine(solvers).parse(argc, argv);
}

}  // namespace drumlin::apps
