#pragma once
// Runs the Python scripts that draw figures and write pages.
#include <string>
#include <vector>

namespace drumlin::apps {

/// Runs apps/figures/SCRIPT (an absolute path stands for itself) with these arguments and waits for it.
/// Throws IoError with what the script printed if it cannot be started or fails.
void draw_figures(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace drumlin::apps
