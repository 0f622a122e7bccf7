#include "apps/command_line/completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

namespace drumlin::apps {
namespace {

/// Visits each command and subcommand with its name in full, "scene check", and its options.
template <class Visit>
void each_command(const std::vector<Command>& commands, const Visit& visit, const std::string& before = "") {
  for (const Command& command : commands) {
    const auto call = command.call ? command.call() : nullptr;
    visit(before + command.name, command, call ? call->description() : Description{});
    each_command(command.subcommands, visit, before + command.name + " ");
  }
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

std::string bash_completion(const std::vector<Command>& commands) {
  std::string names, words, choices;
  for (const Command& command : commands) names += command.name + " ";
  each_command(commands, [&](std::string name, const Command& command, const Description& description) {
    const std::size_t blank = name.find(' ');
    if (blank != std::string::npos) name[blank] = '/';
    std::vector<std::string> after;
    for (const Command& sub : command.subcommands) after.push_back(sub.name);
    after.push_back("--help");
    for (const Option& option : description.options()) {
      if (!option.is_positional()) after.push_back("--" + option.name());
      if (!option.choices().empty())
        choices += fmt::format("    {}/{}) COMPREPLY=($(compgen -W \"{}\" -- \"$current\")); return ;;\n",
                               name, option.is_positional() ? name : "--" + option.name(),
                               fmt::join(option.choices(), " "));
    }
    words += fmt::format("    {}) words=\"{}\" ;;\n", name, fmt::join(after, " "));
  });
  return fmt::format(
      R"(# Completion of drumlin in bash: source <(drumlin --completion bash)
_drumlin() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" command="${{COMP_WORDS[1]}}" words=""
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "{}--help --version --completion --man --commands" -- "$current"))
    return
  fi
  case "$command/$before" in
{}  esac
  [ "$command" = scene ] && [ "$COMP_CWORD" -gt 2 ] && command="scene/${{COMP_WORDS[2]}}"
  case "$command" in
{}  esac
  if [[ "$current" == -* ]] || [ "$command" = scene ]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  fi
}}
complete -o default -F _drumlin drumlin
)",
      names, choices, words);
}

std::string fish_completion(const std::vector<Command>& commands) {
  std::string text = "# Completion of drumlin in fish\n";
  each_command(commands,
               [&](const std::string& name, const Command& command, const Description& description) {
                 const std::size_t blank = name.find(' ');
                 const std::string after = "'__fish_seen_subcommand_from " + name.substr(0, blank) + "'";
                 text += fmt::format("complete -c drumlin -n {} -a {} -d {}\n",
                                     blank == std::string::npos ? "__fish_use_subcommand" : after,
                                     command.name, in_quotes(command.sentence));
                 if (blank != std::string::npos) return;
                 for (const Option& option : description.options())
                   if (!option.is_positional())
                     text += fmt::format("complete -c drumlin -n {} -l {} -d {}\n", after, option.name(),
                                         in_quotes(option.help_text()));
               });
  return text;
}

}  // namespace

std::string completion(const std::string& shell, const std::vector<Command>& commands) {
  if (shell == "fish") return fish_completion(commands);
  return (shell == "zsh" ? "#compdef drumlin\nautoload -U +X bashcompinit && bashcompinit\n" : "") +
         bash_completion(commands);
}

std::string man_page(const std::vector<Command>& commands, const std::string& notes) {
  std::string text =
      ".TH DRUMLIN 1\n.SH NAME\ndrumlin \\- dense granular flow, grains and continuum\n.SH SYNOPSIS\n"
      ".B drumlin\n.I COMMAND\n[options]\n.SH COMMANDS\n";
  each_command(commands,
               [&](const std::string& name, const Command& command, const Description& description) {
                 text += fmt::format(".SS {}", in_roff(name));
                 for (const Option& option : description.options())
                   if (option.is_positional()) text += " " + in_roff(option.kind_text());
                 text += "\n" + in_roff(command.sentence) + "\n";
                 for (const Option& option : description.options())
                   if (!option.is_positional())
                     text += fmt::format(".TP\n.B \\-\\-{} {}\n{}\n", in_roff(option.name()),
                                         in_roff(option.kind_text()), in_roff(option.help_text()));
               });
  return text + ".SH NOTES\n" + in_roff(notes) + "\n";
}

std::string commands_as_json(const std::vector<Command>& commands) {
  auto json = nlohmann::ordered_json::array();
  each_command(
      commands, [&](const std::string& name, const Command& command, const Description& description) {
        if (command.call)
          json.push_back({{"name", name}, {"sentence", command.sentence}, {"options", page_of(description)}});
      });
  return json.dump(1);
}

}  // namespace drumlin::apps
