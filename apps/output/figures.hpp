#pragma once
// Runs the Python scripts that draw figures, write pages, plan work and study runs.
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace drumlin::apps {

/// Runs apps/figures/SCRIPT (an absolute path stands for itself) with these arguments and waits for it.
/// Throws IoError with what the script printed if it cannot be started or fails.
void draw_figures(const std::string& script, const std::vector<std::string>& arguments);

/// Runs a script of the Python package, by its path from drumlin/study; returns what it printed. Throws
/// InputError of that where it refuses its input, else as draw_figures().
std::string study_by_script(const std::string& script, const std::vector<std::string>& arguments);

/// Runs a script that has this program work for it: each line that it prints is a wish in JSON, and `answer`
/// gives the line that it reads next. What `answer` throws ends the script; other errors as above.
void work_for_script(const std::string& script,
                     const std::function<nlohmann::ordered_json(const nlohmann::ordered_json&)>& answer);

}  // namespace drumlin::apps
