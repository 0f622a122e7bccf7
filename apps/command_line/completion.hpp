#pragma once
// The commands of the program for a shell that completes words, for man, and for other programs.
#include <string>
#include <vector>

#include "apps/command_line/command.hpp"

namespace drumlin::apps {

/// A script for the shell "bash", "zsh" or "fish" that completes commands, their subcommands, options and
/// choices; file names elsewhere.
std::string completion(const std::string& shell, const std::vector<Command>& commands);

/// A page for man, of all commands and their options; `notes` at its end.
std::string man_page(const std::vector<Command>& commands, const std::string& notes);

/// All commands with their options, in JSON: what the Python package calls them by.
std::string commands_as_json(const std::vector<Command>& commands);

}  // namespace drumlin::apps
