#pragma once
// JSON documents of the project: read with its errors, each checked for its format.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace drumlin {

/// Throws InputError if the file is missing, no JSON object, or its "format" is not `format`.
nlohmann::ordered_json read_json(const std::filesystem::path& file, const std::string& format);

/// A text without its quotes, any other value as it stands in JSON.
std::string plain_text(const nlohmann::ordered_json& value);

}  // namespace drumlin
