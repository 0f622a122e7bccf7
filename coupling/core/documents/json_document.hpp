#pragma once
// JSON documents of the project, read with its errors (records of a format: described.hpp).
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace drumlin {

/// A text as JSON; `name` stands for the file in messages. Throws InputError on wrong syntax, on numbers that
/// are too large, on more than 32 levels, on a table of more than 10,000 keys.
nlohmann::ordered_json parse_json(const std::string& text, const std::string& name);

/// Throws InputError if the file is missing, larger than 64 MiB, no JSON object, or if its "format" is not
/// `format`.
nlohmann::ordered_json read_json(const std::filesystem::path& file, const std::string& format);

}  // namespace drumlin
