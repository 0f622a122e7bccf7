#pragma once
// Reads the measured runs that a calibration starts from.
#include <vector>

#include "apps/commands/calibrate/calibrate.hpp"
#include "coupling/calibration/run_evidence.hpp"
#include "coupling/core/results/measured_run.hpp"

namespace drumlin::apps {

/// Maps or profiles, and which for "auto". Throws InputError where maps are asked for and a run has none.
coupling::EvidenceSource source_of(const CalibrateOptions& options);

/// Runs as they were read, and what they say of the law, in the same order.
struct MeasuredEvidence {
  std::vector<MeasuredRun> runs;
  std::vector<coupling::RunEvidence> evidence;
};

/// Reads the runs strictly. Throws InputError.
MeasuredEvidence evidence_of(const std::vector<std::filesystem::path>& runs, coupling::EvidenceSource source,
                             const CalibrateOptions& options);

/// Throws InputError where the volume fraction of the bulk was not measured, which a law needs.
void require_bulk_fraction(const MeasuredEvidence& runs);

}  // namespace drumlin::apps
