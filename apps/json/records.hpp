#pragma once
// What is read of the JSON of drumlin cost and drumlin plot (docs/formats/cost.md, run.md).
#include "coupling/core/documents/described.hpp"

namespace drumlin::apps {

/// Long runs at one setting, or what they have below a point of cost.json.
struct LongRunRecord {
  OrNull<double> tolerance, step_s, cpu_seconds, missed_share;
  std::optional<bool> another_scene;
};
DRUMLIN_DESCRIBED(LongRunRecord, tolerance, step_s, cpu_seconds, missed_share, another_scene)

struct ConvergenceRecord {
  static constexpr const char* format = "drumlin-convergence-1";
  std::optional<std::string> scene;
  std::map<std::string, LongRunRecord> settings;
};
DRUMLIN_DESCRIBED(ConvergenceRecord, scene, settings)

struct StatisticsRecord {
  OrNull<double> cpu_seconds, missed_share;
  OfShape<JsonTable> scalars;
};
DRUMLIN_DESCRIBED(StatisticsRecord, cpu_seconds, missed_share, scalars)

struct CostRowRecord {
  OfShape<std::string> name;
  OrNull<double> tolerance, step_s;
  std::optional<StatisticsRecord> statistics;
};
DRUMLIN_DESCRIBED(CostRowRecord, name, tolerance, step_s, statistics)

struct CostRecord {
  static constexpr const char* format = "drumlin-cost-1";
  std::optional<std::string> kind, scene;
  std::vector<CostRowRecord> points;
};
DRUMLIN_DESCRIBED(CostRecord, kind, scene, points)

struct CostMarkRecord {
  double simulated_seconds = 0;
  OfShape<Numbers> errors;
};
DRUMLIN_DESCRIBED(CostMarkRecord, simulated_seconds, errors)

struct VelocityRecord {
  std::vector<OrNull<double>> v_x;
};
DRUMLIN_DESCRIBED(VelocityRecord, v_x)

struct CostPointRecord {
  static constexpr const char* format = "drumlin-cost-point-1";
  std::string name;
  OfShape<std::string> failure;
  OrNull<double> cpu_seconds, seconds;
  OfShape<double> iterations, peak_memory_mb;
  OfShape<std::vector<CostMarkRecord>> marks;
  OfShape<JsonTable> settings, scalars, statistics;
  OfShape<VelocityRecord> profile;
  OrNull<std::map<std::string, JsonTable>> phases;
};
DRUMLIN_DESCRIBED(CostPointRecord, name, failure, cpu_seconds, seconds, iterations, peak_memory_mb, marks,
                  settings, scalars, statistics, profile, phases)

struct PlotsRecord {
  static constexpr const char* format = "drumlin-plots-1";
  std::map<std::string, std::string> figures;
};
DRUMLIN_DESCRIBED(PlotsRecord, figures)

}  // namespace drumlin::apps
