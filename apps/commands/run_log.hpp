#pragma once
// What a run says of its steps: lines of log.csv, and sums for its report.
#include <cstdint>
#include <string>

#include "particles/io/checkpoint_file.hpp"

namespace drumlin::apps {

inline constexpr const char* log_header =
    "step,time_s,stage,contacts,sweeps,residual,residual_max,penetration,sinking,overlap_mean,"
    "overlap_max,kinetic_energy,converged\n";
std::string log_line(const particles::StepReport& report, std::int64_t step, double time_s,
                     const std::string& stage, double kinetic_energy, bool converged);

/// Adds the last step to what a run has added up.
void add_up(const particles::StepReport& report, const particles::Simulation& simulation, bool converged,
            particles::RunTotals& totals);

}  // namespace drumlin::apps
