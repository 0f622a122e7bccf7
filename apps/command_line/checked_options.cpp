#include "apps/command_line/checked_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/process/program_files.hpp"

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

template <class T>
void add_checked(CLI::App& command, const std::string& name, T& target, const std::string& unit,
                 const Allowed& allowed, const std::string& sentence) {
  const std::string range = allowed_text("number", allowed);
  command
      .add_option(name, target, fmt::format("{} [{}{}]", sentence, unit.empty() ? "" : unit + ", ", range))
      ->capture_default_str()
      ->check(within<T>(allowed));
}

}  // namespace

void add_number(CLI::App& command, const std::string& name, double& target, const std::string& unit,
                const Allowed& allowed, const std::string& sentence) {
  add_checked(command, name, target, unit, allowed, sentence);
}

void add_number(CLI::App& command, const std::string& name, int& target, const std::string& unit,
                const Allowed& allowed, const std::string& sentence) {
  add_checked(command, name, target, unit, allowed, sentence);
}

void add_numbers(CLI::App& command, const std::string& name, std::vector<int>& target, const Allowed& allowed,
                 const std::string& sentence) {
  command.add_option(name, target, fmt::format("{} [each {}]", sentence, allowed_text("number", allowed)))
      ->delimiter(',')
      ->type_name("N,N,...")
      ->check(within<int>(allowed));
}

void add_optional_number(CLI::App& command, const std::string& name, std::optional<double>& target,
                         const std::string& unit, const Allowed& allowed, const std::string& sentence) {
  const std::string range = allowed_text("number", allowed);
  command
      .add_option_function<double>(
          name, [&target](const double& number) { target = number; },
          fmt::format("{} [{}{}]", sentence, unit.empty() ? "" : unit + ", ", range))
      ->check(within<double>(allowed));
}

void add_folder_or_file(CLI::App& command, const std::string& name, std::filesystem::path& target,
                        const std::string& kind, const std::string& sentence) {
  command.add_option(name, target, sentence)->required()->type_name(kind);
}

void add_scene_file(CLI::App& command, std::filesystem::path& target, const std::string& sentence) {
  command.add_option("scene", target, sentence + ", or the name of one that drumlin scene list names")
      ->required()
      ->type_name("SCENE.toml")
      ->transform(shipped_scene);
}

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

}  // namespace drumlin::apps
