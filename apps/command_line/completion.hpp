#pragma once
// Completion of commands and options in a shell.
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace drumlin::apps {

/// The subcommands of a program or a command.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// A script for bash that completes the commands of a program, their subcommands and options; file names
/// elsewhere.
std::string bash_completion(const CLI::App& program);

/// The same for zsh, by way of bash's, and for fish.
std::string zsh_completion(const CLI::App& program);
std::string fish_completion(const CLI::App& program);

/// A page for man, of all commands and their options.
std::string man_page(const CLI::App& program);

}  // namespace drumlin::apps
