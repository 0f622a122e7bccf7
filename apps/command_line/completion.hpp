#pragma once
// Completion of commands and options in a shell.
#include <string>

namespace CLI {
class App;
}

namespace drumlin::apps {

/// A script for bash that completes the commands of a program, their subcommands and options; file names
/// elsewhere.
std::string bash_completion(const CLI::App& program);

}  // namespace drumlin::apps
