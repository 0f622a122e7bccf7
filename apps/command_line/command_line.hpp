#pragma once
// From the words of a command line to one call of a command.
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "apps/command_line/command.hpp"

namespace drumlin::apps {

/// Help or version: to be shown, nothing to be done.
struct TextToShow {
  std::string text;
};

/// The call that the words after the name of the program ask for. Throws InputError on wrong usage.
std::variant<TextToShow, std::unique_ptr<Call>> parse_command_line(int argc, const char* const* argv,
                                                                   const std::vector<Command>& commands);

/// For a program that is one command, whose name its words do not say.
template <class Options>
std::variant<TextToShow, Options> parse_options(int argc, const char* const* argv, const Command& command) {
  std::vector<const char*> words = {"drumlin", command.name.c_str()};
  words.insert(words.end(), argv + 1, argv + argc);
  const auto request = parse_command_line(static_cast<int>(words.size()), words.data(), {command});
  if (const auto* shown = std::get_if<TextToShow>(&request)) return *shown;
  return dynamic_cast<const CallOf<Options>&>(*std::get<1>(request)).options;
}

}  // namespace drumlin::apps
