#pragma once
// FLOWRUN/frames/NNNN.h5: a flow with a free surface at one time, from which it goes on
// (docs/formats/flow.md).
#include <filesystem>
#include <string>

#include "continuum/fem/region_march.hpp"

namespace drumlin::continuum {

/// A state with the step that led to it, and what it is the state of.
struct KeptRegion {
  RegionState state;
  RegionStep step;
  std::string scene, law;  ///< texts
};

/// Format "drumlin-flow-frame-2". Throws IoError.
void write_region_state(const std::filesystem::path& file, const KeptRegion& kept);
/// Throws InputError where the file is damaged or of another version.
KeptRegion read_region_state(const std::filesystem::path& file);

}  // namespace drumlin::continuum
