#pragma once
// Writes the files of FLOWRUN (docs/formats/flow.md).
#include <filesystem>

#include "apps/flow/finished_flow.hpp"

namespace drumlin::apps {

/// iterations.csv: one line per nonlinear iteration; also for a flow that did not converge. Throws IoError.
void write_iterations(const std::filesystem::path& file, const continuum::FlowReport& report);

/// profiles.csv, maps.h5, flow.vtu, state.h5, the figures, and last of all flow.json: where that stands, all
/// is there. Collective; the first rank writes. Throws IoError.
void write_flow(const std::filesystem::path& folder, const FinishedFlow& flow);

}  // namespace drumlin::apps
