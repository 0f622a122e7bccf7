#include "apps/command_line/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <type_traits>
#include <utility>

#include "apps/command_line/completion.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/provenance.hpp"
#include "coupling/core/basics/suggestion.hpp"

namespace drumlin::apps {

namespace {

constexpr const char* notes =
    "New here: drumlin new drum -o scene.toml, and docs/tutorial.md.\n"
    "Exit codes: 0 done, 2 wrong usage or input, 3 not converged, 70 a fault of this program, "
    "74 input/output, 129 hung up, 130 interrupted, 143 terminated.\n"
    "Each command has its own --help.";

/// Names stand in results, whose text is UTF-8.
void refuse_unless_utf8(const std::string& word) {
  try {
    (void)nlohmann::json(word).dump();
  } catch (const nlohmann::json::type_error&) {
    throw InputError(word + ": is no UTF-8; name files and folders in it");
  }
}

std::vector<std::string> names_of(const std::vector<Command>& commands) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.name);
  return names;
}

/// Of the words that name a command and its subcommand.
void refuse_unknown_command(std::span<const char* const> words, const std::vector<Command>& commands,
                            const std::string& parent) {
  if (words.empty() || std::string_view(words[0]).starts_with("-")) return;
  const auto found = std::ranges::find(commands, std::string_view(words[0]), &Command::name);
  if (found == commands.end()) {
    const std::string meant = suggestion(words[0], names_of(commands));
    throw InputError(fmt::format(
        "no command is called \"{}{}\"{}", parent.substr(8), words[0],
        meant.empty() ? fmt::format("; {} --help lists them", parent.substr(0, parent.size() - 1)) : meant));
  }
  if (!found->subcommands.empty())
    refuse_unknown_command(words.subspan(1), found->subcommands, parent + found->name + " ");
}

/// What follows the options in the help of a command.
std::string examples_text(const Command& command) {
  return fmt::format("Examples:\n  {}\n\n{}", fmt::join(command.examples, "\n  "), notes);
}

/// One of the choices.
CLI::Validator one_of_words(const std::vector<std::string>& choices) {
  return CLI::Validator(
      [choices](std::string& text) {
        if (std::ranges::find(choices, text) != choices.end()) return std::string();
        return fmt::format("{} is not one of {}{}", text, fmt::join(choices, ", "),
                           suggestion(text, choices));
      },
      "");
}

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

/// An option as the parser knows it, by the type of its member.
struct Adding {
  CLI::App& command;
  const Option& option;

  CLI::Option* operator()(bool* flag) const {
    return command.add_flag(option.names, *flag, option.help_text());
  }
  CLI::Option* operator()(const ExistingWord& flag) const {
    return command.add_flag_callback(
        option.names, [flag] { *flag.existing = flag.word; }, option.help_text());
  }
  template <class T>
  CLI::Option* operator()(T* value) const {
    CLI::Option* added = held<T>(command.add_option(option.names, *value, option.help_text()));
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>)
      if (!option.is_required) added->capture_default_str();
    return added;
  }
  template <class T>
  CLI::Option* operator()(std::optional<T>* value) const {
    return held<T>(command.add_option_function<T>(
        option.names, [value](const T& word) { *value = word; }, option.help_text()));
  }
  template <class T>
  CLI::Option* operator()(std::vector<T>* values) const {
    CLI::Option* added = held<T>(command.add_option(option.names, *values, option.help_text()));
    if (option.is_repeated)
      added->allow_extra_args(false);
    else if (!std::is_same_v<T, std::filesystem::path>)
      added->delimiter(',');
    return added;
  }

 private:
  /// With what one of its values may be.
  template <class T>
  CLI::Option* held(CLI::Option* added) const {
    if constexpr (std::is_arithmetic_v<T>)
      if (option.allowed) added->check(within<T>(*option.allowed));
    if (!option.choices().empty()) added->check(one_of_words(option.choices()));
    return added->type_name(option.kind);
  }
};

void add_options(CLI::App& app, const Description& description) {
  for (const Option& option : description.options()) {
    CLI::Option* added = std::visit(Adding{app, option}, option.member);
    if (option.is_required) added->required();
    if (option.read != nullptr) added->transform(option.read);
  }
  for (const Option& option : description.options()) {
    CLI::Option* added = app.get_option(option.is_positional() ? option.names : "--" + option.name());
    for (const std::string& other : option.needed) added->needs(app.get_option(other));
    for (const std::string& other : option.excluded) added->excludes(app.get_option(other));
  }
}

/// All commands with the calls that they fill in; `chosen` is that of the words.
class CommandLine {
 public:
  explicit CommandLine(const std::vector<Command>& commands)
      : app_("Drumlin: dense granular flow, grains and continuum") {
    const auto shows = [](std::string text) { throw CLI::CallForVersion(std::move(text), 0); };
    app_.name("drumlin");
    app_.set_version_flag("--version", "drumlin " + version_text());
    app_.add_option_function<std::string>(
            "--completion",
            [&commands, shows](const std::string& shell) { shows(completion(shell, commands)); },
            "Prints a script that completes commands and options: source <(drumlin --completion bash)")
        ->check(one_of_words({"bash", "zsh", "fish"}))
        ->type_name("SHELL");
    app_.add_flag_callback(
        "--man", [&commands, shows] { shows(man_page(commands, notes)); },
        "Prints a page for man: man -l <(drumlin --man)");
    app_.add_flag_callback(
        "--commands", [&commands, shows] { shows(commands_as_json(commands)); },
        "Prints all commands with their options as JSON");
    app_.footer(notes);
    add(app_, commands);
  }

  std::variant<TextToShow, std::unique_ptr<Call>> parse(int argc, const char* const* argv) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      std::ostringstream shown, fault;
      if (app_.exit(error, shown, fault) == 0) return TextToShow{shown.str()};
      std::string text = fault.str();
      while (!text.empty() && text.back() == '\n') text.pop_back();
      throw InputError(text + meant_option());
    }
    return std::move(*chosen_);
  }

 private:
  /// For a word that looks like an option and is none.
  std::string meant_option() const {
    const CLI::App* app = &app_;
    while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
    std::vector<std::string> known;
    for (const CLI::Option* option : app->get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    for (const std::string& word : app->remaining())
      if (word.starts_with("--"))
        if (const std::string meant = suggestion(word.substr(0, word.find('=')), known); !meant.empty())
          return "\n" + word + meant;
    return "";
  }

  void add(CLI::App& app, const std::vector<Command>& commands) {
    app.require_subcommand(1);
    for (const Command& command : commands) {
      CLI::App* added = app.add_subcommand(command.name, command.sentence);
      if (!command.examples.empty()) added->footer(examples_text(command));
      if (!command.call) {
        add(*added, command.subcommands);
        continue;
      }
      auto& call = calls_.emplace_back(command.call());
      add_options(*added, call->description());
      added->callback([this, &call] { chosen_ = &call; });
    }
  }

  CLI::App app_;
  std::deque<std::unique_ptr<Call>> calls_;
  std::unique_ptr<Call>* chosen_ = nullptr;
};

}  // namespace

std::variant<TextToShow, std::unique_ptr<Call>> parse_command_line(int argc, const char* const* argv,
                                                                   const std::vector<Command>& commands) {
  for (int k = 1; k < argc; ++k) refuse_unless_utf8(argv[k]);
  refuse_unknown_command({argv + 1, argv + std::max(argc, 1)}, commands, "drumlin ");
  return CommandLine(commands).parse(argc, argv);
}

}  // namespace drumlin::apps
