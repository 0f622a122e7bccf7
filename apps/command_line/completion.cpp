#include "apps/command_line/completion.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/support/commands.hpp"

namespace drumlin::apps {

namespace {

/// Names of the long options, and of the subcommands before them.
std::string words_of(const CLI::App& app) {
  std::string words;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    words += sub->get_name() + " ";
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) words += "--" + name + " ";
  if (!words.empty()) words.pop_back();
  return words;
}

std::string joined(const auto& names) {
  std::string words;
  for (const auto& name : names) words += (words.empty() ? "" : " ") + std::string(name);
  return words;
}

}  // namespace

std::string bash_completion(const CLI::App& program) {
  std::string cases;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), words_of(*command));
    for (const CLI::App* sub : command->get_subcommands([](const CLI::App*) { return true; }))
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

}  // namespace drumlin::apps
