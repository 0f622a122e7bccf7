#pragma once
// Everything that describes one finished flow: what was asked, and the results.
#include <optional>
#include <vector>

#include "continuum/estimates/flow_accuracy.hpp"

namespace drumlin::apps {

/// A scene with a law, and the problem that they make.
struct FlowRequest {
  continuum::FlowScene scene;
  RheologyFit law;
  continuum::FlowCase flow_case;
  std::vector<std::string> accepted = {};  ///< edits by hand of the flow that it starts from (accepted_edits)
  std::string sum = {};                    ///< requested_sum() of all that decides the flow
  bool reduced() const { return scene.reduced || law.reduced; }
};

struct FinishedFlow {
  const FlowRequest& asked;
  continuum::FlowSolution solution;
  std::vector<continuum::MeshResult> meshes;  ///< the last one carries the result
  std::optional<continuum::PlainFlow> plain;  ///< absent where the law takes no fields from the flow
  double cpu_seconds = 0;                     ///< of the solve, on this rank
  int ranks = 1;
  std::vector<double> rank_cpu_seconds,
      rank_peak_memory_mb;  ///< of the whole process, up to the end of the solve
  continuum::FlowFindings findings;
  std::vector<std::string> missed;                    ///< limits (missed_limits); empty: met
  std::vector<continuum::Sensitivity> sensitivities;  ///< empty: not asked for
  continuum::LawBand law_band;                        ///< without draws: not asked for
  continuum::FlowAccuracy accuracy;                   ///< empty of a march
};

/// Named, or brought along by steps in time.
inline bool has_inertia(const continuum::FlowScene& scene) { return scene.effects.inertia || scene.time; }

}  // namespace drumlin::apps
