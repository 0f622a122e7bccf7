#pragma once
// Accuracy of a run by its own log (log.csv), averaged over the stages that were measured.
#include <filesystem>

#include "coupling/core/results/scalar_set.hpp"

namespace drumlin::particles {

/// overlap_mean (d, over loaded contacts, before the position projection) and residual_mean, both averaged
/// over the logged steps, with the intervals of batch means; overlap_max without one. The steps are those of
/// the stages that reach from first_time_s to last_time_s. Needs the columns time_s, stage, overlap_mean,
/// overlap_max, residual; an empty field is left out of the averages. Throws InputError (file, line) on a
/// file that is not of this kind.
ScalarSet accuracy_scalars(const std::filesystem::path& log_csv, double first_time_s, double last_time_s);

}  // namespace drumlin::particles
