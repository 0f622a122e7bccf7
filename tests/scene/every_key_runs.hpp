#pragma once
// Tiny runs through the run command itself, and what is looked at in the folder that they leave.
#include <string>
#include <vector>

#include "particles/bodies/snapshot.hpp"

namespace drumlin::testing {

/// What a run leaves, as far as the same scene leaves the same again: no timings.
struct RunSummary {
  int exit_code = 0;
  std::vector<particles::Snapshot> snapshots;
  std::vector<std::vector<std::string>> log;  ///< fields of each line, names first
  std::string title, status;  ///< status: as run.json tells it, "finished" or how the run ended
  bool reduced = false;
  long long seed = 0, steps = 0;
  bool has_checkpoint = false;
  int captured = 0;  ///< contact problems
  std::string energy_columns, wall_lines;
};

/// Runs a scene in a folder of its own, beside the lists of grains two.csv and three.csv.
RunSummary summary_of_run(const std::string& scene, const std::vector<std::string>& overrides);

/// Looks at one thing; equal texts mean that nothing is to be seen (nine digits).
using Observable = std::string (*)(const RunSummary&);

std::string exit_code(const RunSummary&);
std::string status(const RunSummary&);
std::string title(const RunSummary&);
std::string reduced(const RunSummary&);
std::string steps(const RunSummary&);
std::string checkpoint(const RunSummary&);
std::string captured(const RunSummary&);
std::string energy_columns(const RunSummary&);
std::string wall_lines(const RunSummary&);
std::string positions_mm(const RunSummary&);  ///< of the last snapshot
std::string spins_rad_s(const RunSummary&);
std::string kinetic_energy(const RunSummary&);
std::string density(const RunSummary&);
std::string snapshot_times_s(const RunSummary&);
std::string windows_s(const RunSummary&);  ///< of the displacements stored
std::string logged_sweeps(const RunSummary&);
std::string logged_steps(const RunSummary&);
std::string logged_stages(const RunSummary&);
std::string logged_overlaps(const RunSummary&);

}  // namespace drumlin::testing
