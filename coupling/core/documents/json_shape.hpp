#pragma once
// What the readers of the project's JSON rely on: of each format the values whose type must be what a reader
// takes them for. A file is checked when it is read, so that nothing later stumbles over a value.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {

/// The values of `content` that are of another type than the format says, or missing where it needs them;
/// each with file, key ("settings.scales.length_m", entries of lists by index), what it is and what is
/// allowed. Of a format that has no description: none.
std::vector<InputProblem> type_problems(const std::filesystem::path& file,
                                        const nlohmann::ordered_json& content, const std::string& format);

}  // namespace drumlin
