#pragma once
// Records of runs at several settings, and the accuracy statement of a run as JSON and as text: what stands
// at the end of `drumlin run` and `drumlin measure`.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "coupling/accuracy/accuracy_statement.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::apps {

/// From COST/cost.json of `drumlin cost --statistics`, or a file like data/cost/convergence-6rpm.json. Throws
/// InputError when it holds no long runs, or runs of another scene.
coupling::AccuracyRecord accuracy_record(const std::filesystem::path& file, const particles::Scene& scene);
/// That one of the shipped records that is of this scene, if there is one.
std::optional<coupling::AccuracyRecord> shipped_record(const particles::Scene& scene);

/// As in measured.json (docs/formats/measured.md).
nlohmann::ordered_json to_json(const coupling::AccuracyStatement& statement);
std::string text_of(const coupling::AccuracyStatement& statement);

}  // namespace drumlin::apps
