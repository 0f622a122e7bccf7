#pragma once
// Accuracy statement of a particle run: how far each measured number may be from the truth, by records of
// runs at several settings, and what half of that would cost. It ends `drumlin run` and `drumlin measure`.
#include <array>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "coupling/core/results/scalar_set.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::apps {

/// Runs of one scene at several tolerances and time steps, with what they measured.
struct AccuracyRecord {
  struct Point {
    std::array<double, 2> settings{};  ///< solver tolerance, time step in s
    double cpu_seconds = 0;
    ScalarSet scalars;
  };
  std::string name;  ///< of the file
  std::vector<Point> points;
};

/// From COST/cost.json of `drumlin cost --statistics`, or a file like data/cost/convergence-6rpm.json;
/// without a `file` that one of the shipped records that is of this scene, if there is one. Throws InputError
/// when the file holds no long runs, or runs of another scene.
std::optional<AccuracyRecord> accuracy_record(const std::optional<std::filesystem::path>& file,
                                              const particles::Scene& scene);

/// What the run took, as far as it is known.
struct RunCost {
  double cpu_seconds = 0;
  double simulated_seconds = 0;
  double sampled_seconds = 0;  ///< 0: nothing was sampled
  double turns = 0;            ///< that were sampled; 0: the scene does not turn
};

/// For a run of the scene, as in measured.json (docs/formats/measured.md). `measured`: all scalars with an
/// interval, or none; then those of the record stand in the statement.
nlohmann::ordered_json accuracy_statement(const particles::Scene& scene,
                                          const std::optional<AccuracyRecord>& record,
                                          const ScalarSet& measured, const RunCost& cost);
/// The same in words, with the values of `measured`.
std::string text_of(const nlohmann::ordered_json& statement, const ScalarSet& measured);

}  // namespace drumlin::apps
