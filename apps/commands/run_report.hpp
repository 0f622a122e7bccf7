#pragma once
// The report of a run: run.json, and the summary at its end.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "particles/io/checkpoint_file.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::apps {

/// What a report speaks of; the times in `totals` are up to date.
struct RunProgress {
  const particles::Scene& scene;
  const particles::Simulation& simulation;
  particles::RunTotals totals;
  int threads = 1;
};

/// The content of run.json (docs/formats/run.md).
nlohmann::ordered_json run_report(const RunProgress&, const std::string& status);

/// Steps, accuracy and the table of where the time went, in lines for the user.
std::string run_summary(const RunProgress&);

}  // namespace drumlin::apps
