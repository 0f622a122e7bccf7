#pragma once
// The figures are drawn by the scripts of apps/figures, in an interpreter with matplotlib.
#include <string>
#include <vector>

namespace drumlin::apps {

/// Runs apps/figures/SCRIPT (an absolute path stands for itself) with these arguments and waits for it.
/// Throws IoError with what the script said if it cannot be started or fails: a report without its figures is
/// no report.
void draw_figures(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace drumlin::apps
