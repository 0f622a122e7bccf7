#pragma once
// Checks of where grains come from: regions, sizes, lists and groups.
#include <optional>
#include <string>
#include <vector>

#include "particles/scene/validate.hpp"

namespace drumlin::particles {

void check_grains(const Scene& scene, std::vector<SceneFault>& faults);
/// Whether a distribution lies between its smallest and largest diameter. `key`: its table, with a dot.
bool check_sizes(const std::optional<Sizes>& sizes, double smallest_mm, double largest_mm,
                 const std::string& key, std::vector<SceneFault>& faults);

}  // namespace drumlin::particles
