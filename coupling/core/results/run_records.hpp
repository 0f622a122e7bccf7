#pragma once
// What programs tell of a run, a measurement and a flow beside their numbers: run.json, and what is read of
// measured.json and flow.json (docs/formats).
#include "coupling/core/basics/scales.hpp"
#include "coupling/core/documents/described.hpp"

namespace drumlin {

DRUMLIN_DESCRIBED(Scales, length_m, time_s, density_kg_m3)

/// Of an imported run what its own program knows is not there.
struct RunRecord {
  static constexpr const char* format = "drumlin-run-1";
  OfShape<Line> title;
  std::optional<bool> reduced, imported;
  std::string status;  ///< RunStatus
  std::optional<double> wall_seconds, cpu_seconds, peak_memory_mb, simulated_seconds;
  std::optional<std::int64_t> steps, steps_planned, unconverged_steps, first_unconverged_step, threads,
      grains, snapshots;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> revision;
  OfShape<JsonTable> accuracy, provenance;
  OfShape<Numbers> cost, energy;
  OfShape<Scales> scales;
  Anything imported_from, warnings, stages, regions, left, started_from, ranks;
};
DRUMLIN_DESCRIBED(RunRecord, title, reduced, status, imported, imported_from, wall_seconds, cpu_seconds,
                  peak_memory_mb, steps, steps_planned, unconverged_steps, first_unconverged_step, revision,
                  seed, threads, grains, simulated_seconds, snapshots, accuracy, cost, warnings, stages,
                  regions, left, energy, scales, provenance, started_from, ranks)

struct LawRecord {
  OfShape<std::string> law;
  OfShape<double> nu;
  OfShape<std::vector<std::string>> fitted_on;
};
DRUMLIN_DESCRIBED(LawRecord, law, nu, fitted_on)

struct SettingsRecord {
  OfShape<Line> title;
  OrNull<double> rotation, drum_radius, frame_angle_deg;
  OfShape<LawRecord> law;
  Scales scales;
};
DRUMLIN_DESCRIBED(SettingsRecord, title, rotation, drum_radius, frame_angle_deg, law, scales)

struct SteadinessRecord {
  std::optional<bool> steady;
  std::vector<std::string> reasons;
};
DRUMLIN_DESCRIBED(SteadinessRecord, steady, reasons)

struct MeasuredRecord {
  static constexpr const char* format = "drumlin-measured-1";
  bool reduced = false;
  std::optional<SteadinessRecord> steadiness;
  SettingsRecord settings;
  OfShape<JsonTable> fits, provenance;
  OfShape<double> seconds;
};
DRUMLIN_DESCRIBED(MeasuredRecord, reduced, steadiness, settings, fits, provenance, seconds)

struct MeshRecord {
  double unknowns = 0;
};
DRUMLIN_DESCRIBED(MeshRecord, unknowns)

struct ScalarsRecord {
  JsonTable scalars;
};
DRUMLIN_DESCRIBED(ScalarsRecord, scalars)

struct FlowRecord {
  static constexpr const char* format = "drumlin-flow-run-2";
  std::optional<std::string> geometry;  ///< Geometry; absent: a drum
  bool reduced = false;
  OfShape<double> seconds, cpu_seconds, iterations, unknowns;
  SettingsRecord settings;
  OfShape<std::vector<MeshRecord>> meshes;
  OrNull<ScalarsRecord> closed_form, law_band;
  OrNull<std::map<std::string, JsonTable>> phases;
  std::optional<std::vector<std::string>> missed;  ///< of what its equations ask, a sentence each
};
DRUMLIN_DESCRIBED(FlowRecord, geometry, reduced, seconds, cpu_seconds, iterations, unknowns, settings, meshes,
                  closed_form, law_band, phases, missed)

}  // namespace drumlin
