#pragma once
// JSON files of the commands: read with the errors of the project, written aside and renamed.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "coupling/exchange/provenance.hpp"
#include "coupling/exchange/scalar_set.hpp"
#include "coupling/exchange/scales.hpp"

namespace drumlin::apps {

/// Throws InputError if the file is missing, no JSON object, or its "format" is not `format`.
nlohmann::ordered_json read_json(const std::filesystem::path& file, const std::string& format);

/// Indented, in the order of the keys, NaN as null; written aside and renamed. Throws IoError.
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& content);

/// {"value": , "ci99": } for a measurement, the plain number where there is no interval; null for what was
/// not computed.
nlohmann::ordered_json to_json(const Scalar& scalar);
nlohmann::ordered_json to_json(const Provenance& provenance);
nlohmann::ordered_json to_json(const Scales& scales);

/// Adds each scalar under its name.
void add_scalars(nlohmann::ordered_json& content, const ScalarSet& scalars);

}  // namespace drumlin::apps
