#pragma once
// Writers of study.json and paper_table.md of `drumlin measure --study` (docs/formats/study.md).
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "coupling/study/study.hpp"

namespace drumlin::apps {

std::string name_of(coupling::Verdict verdict);  ///< "agrees", "open", "near", "differs", ...
std::string name_of(coupling::Reason reason);    ///< words for a table

/// Everything but format, reduced, title and provenance.
void add_study(nlohmann::ordered_json& content, const coupling::Study& study);

/// The paper's table in Markdown: one line per entry. Says so when the drum is none of the paper's.
std::string paper_table_markdown(const coupling::Study& study);

}  // namespace drumlin::apps
