#pragma once
// Checks of names, which are fields of CSV files.
#include <set>
#include <string>
#include <vector>

#include "particles/scene/validate.hpp"

namespace drumlin::particles {

/// A name that several may have.
void check_field(const std::string& name, const std::string& key, std::vector<SceneFault>& faults);
/// One that none of `names` is; it becomes one of them.
void check_name(const std::string& name, const std::string& key, std::set<std::string>& names,
                std::vector<SceneFault>& faults);

}  // namespace drumlin::particles
