#include "apps/commands/measure/part.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/commands/measure/forces_part.hpp"
#include "apps/commands/measure/frames_part.hpp"
#include "apps/commands/measure/grains_part.hpp"
#include "apps/commands/measure/maps_part.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::apps {

const std::vector<std::string>& part_names() {
  static const std::vector<std::string> names{"gradients", "slices", "sensitivity",
                                              "voronoi",   "forces", "maps"};
  return names;
}

void check_parts(const std::vector<std::string>& names) {
  const auto& known = part_names();
  for (const std::string& name : names)
    if (name != "none" && std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(fmt::format("--parts: \"{}\" is no part of a measurement (allowed: {}, none)", name,
                                   fmt::join(known, ", ")));
}

bool names_part(const MeasureOptions& options, const std::string& name) {
  const auto& names = options.parts.empty() ? part_names() : options.parts;
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<Part> reading_parts(const MeasureOptions& options) {
  std::vector<Part> parts;
  if (names_part(options, "forces")) parts.push_back(forces_part(options));
  if (names_part(options, "maps")) parts.push_back(maps_part(options));
  if (!options.grains.empty()) parts.push_back(grains_part(options));
  if (asks_for_frames(options)) parts.push_back(frames_part(options));
  return parts;
}

}  // namespace drumlin::apps
