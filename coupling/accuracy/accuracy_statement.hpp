#pragma once
// Accuracy statement of a particle run: how far each measured number may be from the truth, and what half of
// that would cost.
#include <optional>
#include <string>
#include <vector>

#include "coupling/accuracy/setting_error.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin::coupling {

/// Solver tolerance and time step of a run.
struct RunSettings {
  double tolerance = 0, step_s = 0;
};

/// Runs of one scene at several tolerances and time steps, with what they measured.
struct AccuracyRecord {
  struct Point {
    RunSettings settings;
    double cpu_seconds = 0;
    ScalarSet scalars;
  };
  std::string name;  ///< of the file
  std::vector<Point> points;
};

/// A scalar with the errors that a record tells for the settings of the scene.
struct ScalarStatement {
  Scalar measured;                     ///< NaN: nothing has been measured yet
  std::optional<SettingError> solver;  ///< absent: the record does not tell
  std::optional<SettingError> step;
  std::string dominant() const;  ///< "averaging", "solver", "step"; the latter two where they are significant
};

/// What it takes to halve one of them: the setting in words, and the processor time of the whole run with it.
struct RunHalving {
  std::string source, change;
  double cpu_seconds = 0;
};

struct AccuracyStatement {
  std::string record;  ///< empty: none, nothing is known of solver and step
  std::vector<ScalarStatement> scalars;
  std::vector<RunHalving> halvings;
};

/// What the run took, as far as it is known.
struct RunCost {
  double cpu_seconds = 0;
  double simulated_seconds = 0;
  double sampled_seconds = 0;  ///< 0: nothing was sampled
  double turns = 0;            ///< that were sampled; 0: the scene does not turn
};

/// For a run with these settings. `measured`: all scalars with an interval, or none; then those of the record
/// stand in the statement without a value.
AccuracyStatement accuracy_statement(const RunSettings& settings, const std::optional<AccuracyRecord>& record,
                                     const ScalarSet& measured, const RunCost& cost);

}  // namespace drumlin::coupling
