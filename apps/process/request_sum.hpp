#pragma once
// What a command was asked for, as one checksum: --resume takes what is done already only if it was asked for
// the same.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace drumlin::apps {

/// Of the options that decide the results, and of input_sum() of what they are computed from.
std::string request_sum(const nlohmann::ordered_json& requested);

/// What an input holds now: the bytes of a file; of a result folder what its manifest says; of measurements
/// or a flow that were cut out of one all files but snapshots. Empty of anything else. Throws InputError and
/// IoError.
std::string input_sum(const std::filesystem::path& input);
/// The same of a run and what was measured on it.
std::string measured_run_sum(const std::filesystem::path& run);

/// Throws InputError where the results in a folder were made for something else. Folders of earlier programs
/// do not say what they were made for.
void refuse_other(const std::filesystem::path& folder, const std::string& requested);

}  // namespace drumlin::apps
