#pragma once
// Files with the numbers behind a comparison: both sides at the same places.
#include <filesystem>
#include <vector>

#include "coupling/comparison/comparison.hpp"

namespace drumlin::apps {

/// Writes overlay.csv (centre), overlay_slices/x+NN.N.csv and overlay_maps.h5 (each where that part was
/// compared) into the folder: NAME_particles with its interval and NAME_continuum, z of the first side.
void write_overlays(const std::filesystem::path& folder, const coupling::ComparedSide& first,
                    const coupling::ComparedSide& second, const coupling::Comparison& comparison);

}  // namespace drumlin::apps
