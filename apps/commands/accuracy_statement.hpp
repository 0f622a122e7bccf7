#pragma once
// How far a measured number of a particle run may be from the truth, and what half of that would cost: the
// statement at the end of `drumlin run` and `drumlin measure`.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "coupling/accuracy/setting_error.hpp"
#include "coupling/exchange/scalar_set.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::apps {

/// Runs of one scene at several tolerances and time steps, with what they measured.
struct AccuracyRecord {
  struct Point {
    double tolerance = 0, step_s = 0;
    double cpu_seconds = 0;
    ScalarSet scalars;
  };
  std::string name;  ///< of the file
  Scene scene;
  std::vector<Point> points;
};

/// The scene without what does not change what is computed: title, seed, solver, output, time steps, lengths
/// of stages and their snapshots.
Scene physics_of(Scene scene);

/// From COST/cost.json of `drumlin cost --statistics`, or a file like data/cost/convergence-6rpm.json. Throws
/// InputError when it holds no long runs, or runs of another scene.
AccuracyRecord accuracy_record(const std::filesystem::path& file, const Scene& scene);
/// That one of the shipped records that is of this scene, if there is one.
std::optional<AccuracyRecord> shipped_record(const Scene& scene);

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

/// `measured`: all scalars with an interval, or none; then those of the record stand in the statement without
/// a value.
AccuracyStatement accuracy_statement(const Scene& scene, const std::optional<AccuracyRecord>& record,
                                     const ScalarSet& measured, const RunCost& cost);

/// As in measured.json (docs/formats/measured.md).
nlohmann::ordered_json to_json(const AccuracyStatement& statement);
std::string text_of(const AccuracyStatement& statement);

}  // namespace drumlin::apps
