#pragma once
// The report of a run: run.json, and the summary at its end.
#include <cstdint>
#include <string>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/results/run_records.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::apps {

/// What a report speaks of; the times in `totals` are up to date.
struct RunProgress {
  const particles::Scene& scene;
  const particles::Simulation& simulation;
  particles::RunTotals totals;
  int threads = 1;
};

/// How far a run has come.
struct RunPosition {
  const particles::Scene& scene;
  std::int64_t steps_at_start = 0, step = 0, steps = 0;
  int stage = 0;
  double simulated_seconds = 0, spent_seconds = 0;
  std::int64_t missed = 0;  // steps that missed a tolerance
};

/// Its line of progress. `who` is "run", or "run on 3 ranks".
std::string progress_line(const std::string& who, const RunPosition&, const particles::StepReport& last);

/// Of the steps of a run: fewer that miss a tolerance leave no trace in averages.
inline constexpr double unseen_missed_share = 0.01;
/// Of a run that has come to its end: not_converged where most of its steps missed a tolerance.
ExitCode exit_code_of_missed(std::int64_t missed, std::int64_t steps);

/// The content of run.json (docs/formats/run.md).
RunRecord run_report(const RunProgress&, RunStatus status);

/// What a user must know before the results are used: steps that missed a tolerance, overlap that discs
/// should not have, a start that overlaps. None where all holds.
std::vector<std::string> run_warnings(const RunProgress&);
/// The last of them; empty where nothing overlaps.
std::string start_warning(const particles::StartOverlaps&);

/// Of a run that is unfinished, for who reads it so far; else empty.
std::string as_far_as_it_went(const particles::RunFolder& run);

/// Steps, accuracy and the table of where the time went, in lines for the user; the warnings end it.
std::string run_summary(const RunProgress&);

}  // namespace drumlin::apps
