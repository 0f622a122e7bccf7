#pragma once
// Writers of comparison.json (docs/formats/comparison.md).
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "coupling/comparison/comparison.hpp"
#include "coupling/comparison/layers.hpp"
#include "coupling/comparison/paper_table.hpp"

namespace drumlin::apps {

/// Quantity, zone (of a field), measure, limit, value, outcome, and the remark where there is one.
nlohmann::ordered_json to_json(const coupling::Target& target);

/// How many targets are met, missed and not measured.
nlohmann::ordered_json counts_of(const std::vector<coupling::Target>& targets);

/// Keys verdict, registration, zones, errors, slices, maps, scalars and targets. `floor`: another run of the
/// first side against it, whose errors stand beside (floor_rel_l2, floor_rms, of a target floor); null:
/// none.
void add_comparison(nlohmann::ordered_json& content, const coupling::Comparison& comparison,
                    const coupling::Comparison* floor = nullptr);

/// Keys geometry, registration, zones, errors and scalars of flows in layers; `floor` as above.
void add_layer_comparison(nlohmann::ordered_json& content, const coupling::LayerComparison& comparison,
                          const coupling::LayerComparison* floor = nullptr);

/// Key paper: the speed and one row per number; null when the drum is none of the paper's.
void add_paper(nlohmann::ordered_json& content, std::optional<double> rotation_rpm,
               const std::vector<coupling::PaperRow>& rows);

}  // namespace drumlin::apps
