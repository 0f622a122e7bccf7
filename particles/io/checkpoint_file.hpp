#pragma once
// checkpoint.h5: everything that a run needs to go on as if it had never stopped (docs/formats/snapshot.md).
#include <cstdint>
#include <filesystem>
#include <string>

#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {

/// What a run has added up so far.
struct RunTotals {
  /// The overlaps of the last stage so far, and the step that had the deepest.
  struct StageOverlaps {
    std::int64_t stage = 0, steps = 0;
    double sum = 0, max = 0;
    std::int64_t step = 0, grain = 0, other = 0;  ///< grains count from 1; 0: a wall
    double time_s = 0, x = 0, z = 0;
  } stage_overlaps;

  std::int64_t unconverged_steps = 0;
  std::int64_t first_unconverged_step = 0;  ///< 0: none
  std::int64_t unresolved_impacts = 0;      ///< StepReport::impacts_unresolved, summed
  std::int64_t sweeps = 0;
  std::int64_t contacts = 0;  ///< summed over the steps
  double contact_sweeps = 0;  ///< contacts times sweeps, summed
  double residual_sum = 0, residual_max = 0;
  double penetration_sum = 0, penetration_max = 0;
  double sinking_sum = 0, sinking_max = 0;
  double overlap_sum = 0, overlap_max = 0;
  double wall_seconds = 0, cpu_seconds = 0;
  double detection_seconds = 0, setup_seconds = 0, solver_seconds = 0, projection_seconds = 0,
         output_seconds = 0;
};

struct Checkpoint {
  std::string scene;              ///< resolved; a checkpoint belongs to one scene
  std::int64_t log_bytes = 0;     ///< of log.csv at this step: what stands behind is cut off on resuming
  std::int64_t energy_bytes = 0;  ///< of energy.csv, if there is one
  RunTotals totals;
  SimulationState state;
  std::int64_t walls_bytes = 0;    ///< of walls.csv, if there is one
  std::int64_t regions_bytes = 0;  ///< of regions.csv, if there is one
};

/// Throws IoError; an older checkpoint is then untouched.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);
/// Throws InputError when the file is missing, damaged or of another version.
Checkpoint read_checkpoint(const std::filesystem::path& file);

/// The bytes of the file of a checkpoint.
std::string checkpoint_image(const Checkpoint& checkpoint);
/// Writes them to RUN/checkpoint.h5; the one before stays as the previous one. Throws IoError, both being
/// intact then.
void keep_checkpoint(const std::filesystem::path& run, const std::string& image);
void keep_checkpoint(const std::filesystem::path& run, const Checkpoint& checkpoint);

}  // namespace drumlin::particles
