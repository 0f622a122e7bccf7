#pragma once
// The text that ends `drumlin flow` on the terminal.
#include <filesystem>
#include <string>

#include "apps/flow/finished_flow.hpp"

namespace drumlin::apps {

/// Balances and closed form, what k and settings change, accuracy, seconds by kind of work, neglected terms.
std::string finished_text(const std::filesystem::path& folder, const FinishedFlow& flow);

}  // namespace drumlin::apps
