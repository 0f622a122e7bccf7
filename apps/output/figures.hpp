#pragma once
// Runs the Python scripts that draw figures, write pages, plan work and study runs.
#include <functional>
#include <string>
#include <vector>

namespace drumlin::apps {

/// Runs apps/figures/SCRIPT (an absolute path stands for itself) with these arguments and waits for it.
/// Throws IoError with what the script printed if it cannot be started or fails.
void draw_figures(const std::string& script, const std::vector<std::string>& arguments);

/// The same of a script whose output is wanted: returns what it printed, without the lines that `take` takes.
/// Throws InputError of that where it refuses its input.
std::string output_of_script(const std::string& script, const std::vector<std::string>& arguments,
                             const std::function<bool(const std::string&)>& take = {});

/// Runs a script that is all of a command: what it prints is printed, its errors go where ours go. Returns
/// its exit code.
int end_of_command(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace drumlin::apps
