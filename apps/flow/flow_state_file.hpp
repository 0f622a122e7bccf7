#pragma once
// FLOWRUN/state.h5: what another flow can start from (docs/formats/flow.md).
#include <filesystem>

#include "continuum/fem/flow_state.hpp"

namespace drumlin::apps {

/// Format "drumlin-flow-state-1", the same bytes for any number of ranks. Throws IoError.
void write_flow_state(const std::filesystem::path& file, const FlowState& state);

/// `flow_run`: a FLOWRUN. Throws InputError naming the file when it is missing, damaged or of another
/// version.
FlowState read_flow_state(const std::filesystem::path& flow_run);

}  // namespace drumlin::apps
