#include "particles/scene/validate_names.hpp"

#include <fmt/format.h>

namespace drumlin::particles {

void check_field(const std::string& name, const std::string& key, std::vector<SceneFault>& faults) {
  if (name.find_first_of(",\"\n\r") != std::string::npos)
    faults.push_back({key, "holds a comma, a quote or a line end", "a name without them", {key}});
}

void check_name(const std::string& name, const std::string& key, std::set<std::string>& names,
                std::vector<SceneFault>& faults) {
  if (!names.insert(name).second)
    faults.push_back({key, fmt::format("\"{}\" appears twice", name), "a name of its own", {key}});
  check_field(name, key, faults);
}

}  // namespace drumlin::particles
