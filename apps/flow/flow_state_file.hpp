#pragma once
// FLOWRUN/state.h5: what another flow can start from (docs/formats/flow.md).
#include <filesystem>
#include <string>

#include "continuum/fem/flow_state.hpp"

namespace drumlin::apps {

/// Format "drumlin-flow-state-1", the same bytes for any number of ranks. Throws IoError.
void write_flow_state(const std::filesystem::path& file, const FlowState& state);

/// `flow_run`: a FLOWRUN. Throws InputError naming the file when it is missing, damaged or of another
/// version.
FlowState read_flow_state(const std::filesystem::path& flow_run);

/// What a march goes on from.
struct FlowCheckpoint {
  FlowState state;
  int steps = 0;           ///< that are done
  double start_share = 0;  ///< speed of rotation at the start over that of the scene
  std::string scene, law;  ///< texts of both files: another scene does not go on from here
};

/// Format "drumlin-flow-checkpoint-1". Throws IoError.
void write_flow_checkpoint(const std::filesystem::path& file, const FlowCheckpoint& checkpoint);

/// Throws InputError as read_flow_state.
FlowCheckpoint read_flow_checkpoint(const std::filesystem::path& file);

}  // namespace drumlin::apps
