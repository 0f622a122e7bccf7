#pragma once
// JSON files of the commands, written aside and renamed, and the values that all of them hold.
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/core/basics/provenance.hpp"
#include "coupling/core/documents/described.hpp"
#include "coupling/core/law/law_curve.hpp"
#include "coupling/core/results/scalar_set.hpp"

namespace drumlin {
DRUMLIN_DESCRIBED(Provenance, revision, compiler, build_type, machine, processors)
DRUMLIN_DESCRIBED(LawCurve, I, mu)
}  // namespace drumlin

namespace drumlin::apps {

/// Indented, in the order of the keys, NaN as null; written aside and renamed. Throws IoError.
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& content);

/// Adds "accepted_edits" to a provenance if there are any (`accepted_edits` of result_folder.hpp).
void add_accepted_edits(nlohmann::ordered_json& provenance, const std::vector<std::string>& edits);

/// {"value": , "ci99": } for a measurement, the plain number where there is no interval; null for what was
/// not computed.
nlohmann::ordered_json to_json(const Scalar& scalar);

/// Adds each scalar under its name.
void add_scalars(nlohmann::ordered_json& content, const ScalarSet& scalars);

}  // namespace drumlin::apps
