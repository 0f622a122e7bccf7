#pragma once
// Reads and writes FLOWRUN/state.h5, from which another flow can start, and checkpoint.h5 of a march
// (docs/formats/flow.md).
#include <filesystem>
#include <string>

#include "continuum/time_stepping/march_state.hpp"

namespace drumlin::continuum {

/// Format "drumlin-flow-state-1", the same bytes for any number of ranks. Throws IoError.
void write_flow_state(const std::filesystem::path& file, const FlowState& state);

/// `flow_run`: a FLOWRUN. Throws InputError naming the file when it is missing, damaged or of another
/// version.
FlowState read_flow_state(const std::filesystem::path& flow_run);

/// What an interrupted march goes on from, with the texts of its scene and law: another scene does not go on
/// from here.
struct FlowCheckpoint {
  MarchState at;
  std::string scene, law;
};

/// FLOWRUN/checkpoint.h5, format "drumlin-flow-checkpoint-1"; the one before stays as the previous one.
/// Throws IoError.
void keep_flow_checkpoint(const std::filesystem::path& flow_run, const FlowCheckpoint& checkpoint);

/// Throws InputError as read_flow_state.
FlowCheckpoint read_flow_checkpoint(const std::filesystem::path& file);

}  // namespace drumlin::continuum
