#pragma once
// Runs and flows of a study, read from their folders.
#include <filesystem>

#include "coupling/study/speed_comparison.hpp"
#include "coupling/study/study_run.hpp"

namespace drumlin::coupling {

/// As read_measured_run, with what must be the same in all runs of a study. A run that is not steady is read,
/// with warnings.
StudyRun read_study_run(const std::filesystem::path& folder);

/// As read_flow_run, with the law and the effects.
StudyFlow read_study_flow(const std::filesystem::path& folder);

}  // namespace drumlin::coupling
