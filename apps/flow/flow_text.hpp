#pragma once
// What a finished flow says on the terminal.
#include <string>

#include "apps/flow/flow_files.hpp"

namespace drumlin::apps {

/// Balances and closed form, what k and settings move, where the time went, what is left out.
std::string finished_text(const std::filesystem::path& folder, const FinishedFlow& flow);

}  // namespace drumlin::apps
