#include "apps/commands/start_grains.hpp"

#include <utility>

#include "coupling/core/files/checksum.hpp"
#include "coupling/core/results/run_records.hpp"
#include "particles/io/grains_of_run.hpp"

namespace drumlin::apps {

nlohmann::ordered_json take_over_grains(particles::Scene& scene) {
  const auto* requested = std::get_if<particles::GrainsOfRun>(&scene.grains.source);
  if (!requested) return nullptr;
  particles::GrainsTakenOver taken = particles::grains_of_run(*requested);
  const auto theirs = read_record<RunRecord>(taken.run.folder / "run.json");
  nlohmann::ordered_json chain = {
      {"run", taken.run.folder.string()},         {"title", taken.run.scene.title},
      {"revision", theirs.revision.value_or("")}, {"snapshot", taken.snapshot.filename().string()},
      {"sum", file_sum(taken.snapshot).checksum}, {"time_s", taken.time_s}};
  if (const auto& before = theirs.started_from.json; !before.is_null()) chain["started_from"] = before;
  scene.grains.source = std::move(taken.grains);
  return chain;
}

}  // namespace drumlin::apps
