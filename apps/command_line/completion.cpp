#include "apps/command_line/completion.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/output/commands.hpp"

namespace drumlin::apps {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

namespace {

/// Names of the long options, and of the subcommands before them.
std::string words_of(const CLI::App& app) {
  std::string words;
  for (const CLI::App* sub : commands_of(app)) words += sub->get_name() + " ";
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) words += "--" + name + " ";
  if (!words.empty()) words.pop_back();
  return words;
}

/// Visits long name, type and meaning of each option but the positional ones and --help.
template <class Visit>
void each_option(const CLI::App& command, Visit visit) {
  for (const CLI::Option* option : command.get_options())
    if (!option->get_lnames().empty() && !option->check_lname("help"))
      visit(option->get_lnames().front(), option->get_type_name(), option->get_description());
}

std::string in_quotes(std::string text) {
  for (std::size_t at = 0; (at = text.find('\'', at)) != text.npos; at += 4) text.replace(at, 1, "'\\''");
  return "'" + text + "'";
}

/// Roff takes a hyphen for a break, a point or quote at the beginning of a line for a request.
std::string in_roff(const std::string& text) {
  std::string roff;
  for (const char letter : text) {
    if (letter == '\\') roff += '\\';
    if (letter == '-') roff += '\\';
    roff += letter;
  }
  return roff.starts_with(".") || roff.starts_with("'") ? "\\&" + roff : roff;
}

std::string joined(const auto& names) {
  std::string words;
  for (const auto& name : names) words += (words.empty() ? "" : " ") + std::string(name);
  return words;
}

}  // namespace

std::string bash_completion(const CLI::App& program) {
  std::string cases;
  for (const CLI::App* command : commands_of(program)) {
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), words_of(*command));
    for (const CLI::App* sub : commands_of(*command))
      cases +=
          fmt::format("    {}/{}) words=\"{}\" ;;\n", command->get_name(), sub->get_name(), words_of(*sub));
  }
  return fmt::format(
      R"(# Completion of drumlin in bash: source <(drumlin --completion bash)
_drumlin() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" command="${{COMP_WORDS[1]}}" words=""
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "{}" -- "$current"))
    return
  fi
  case "$before" in
    --color) COMPREPLY=($(compgen -W "{}" -- "$current")); return ;;
    new) COMPREPLY=($(compgen -W "{}" -- "$current")); return ;;
  esac
  [ "$command" = scene ] && [ "$COMP_CWORD" -gt 2 ] && command="scene/${{COMP_WORDS[2]}}"
  case "$command" in
{}  esac
  if [[ "$current" == -* ]] || [ "$command" = scene ]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  fi
}}
complete -o default -F _drumlin drumlin
)",
      words_of(program), joined(plot_colors), joined(scene_kinds), cases);
}

std::string zsh_completion(const CLI::App& program) {
  return "#compdef drumlin\nautoload -U +X bashcompinit && bashcompinit\n" + bash_completion(program);
}

std::string fish_completion(const CLI::App& program) {
  std::string text = "# Completion of drumlin in fish\n";
  for (const CLI::App* command : commands_of(program)) {
    text += fmt::format("complete -c drumlin -n __fish_use_subcommand -a {} -d {}\n", command->get_name(),
                        in_quotes(command->get_description()));
    const auto add = [&](const std::string& name, const std::string&, const std::string& sentence) {
      text += fmt::format("complete -c drumlin -n '__fish_seen_subcommand_from {}' -l {} -d {}\n",
                          command->get_name(), name, in_quotes(sentence));
    };
    each_option(*command, add);
    for (const CLI::App* sub : commands_of(*command))
      text += fmt::format("complete -c drumlin -n '__fish_seen_subcommand_from {}' -a {} -d {}\n",
                          command->get_name(), sub->get_name(), in_quotes(sub->get_description()));
  }
  return text;
}

std::string man_page(const CLI::App& program) {
  std::string text =
      ".TH DRUMLIN 1\n.SH NAME\ndrumlin \\- dense granular flow, grains and continuum\n.SH SYNOPSIS\n"
      ".B drumlin\n.I COMMAND\n[options]\n.SH COMMANDS\n";
  const auto add_command = [&](const std::string& name, const CLI::App& command) {
    text += fmt::format(".SS {}", in_roff(name));
    for (const CLI::Option* option : command.get_options())
      if (option->get_positional()) text += " " + in_roff(option->get_type_name());
    text += "\n" + in_roff(command.get_description()) + "\n";
    each_option(
        command, [&](const std::string& option, const std::string& type, const std::string& sentence) {
          text += fmt::format(".TP\n.B \\-\\-{} {}\n{}\n", in_roff(option), in_roff(type), in_roff(sentence));
        });
  };
  for (const CLI::App* command : commands_of(program)) {
    add_command(command->get_name(), *command);
    for (const CLI::App* sub : commands_of(*command))
      add_command(command->get_name() + " " + sub->get_name(), *sub);
  }
  return text + ".SH NOTES\n" + in_roff(program.get_footer()) + "\n";
}

}  // namespace drumlin::apps
