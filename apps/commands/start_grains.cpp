#include "apps/commands/start_grains.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "coupling/core/documents/json_document.hpp"
#include "coupling/core/files/checksum.hpp"
#include "particles/io/grains_of_run.hpp"

namespace drumlin::apps {

nlohmann::ordered_json take_over_grains(particles::Scene& scene) {
  const auto* asked = std::get_if<particles::GrainsOfRun>(&scene.grains.source);
  if (!asked) return nullptr;
  particles::GrainsTakenOver taken = particles::grains_of_run(*asked);
  const auto theirs = read_json(taken.run.folder / "run.json", "drumlin-run-1");
  nlohmann::ordered_json chain = {
      {"run", taken.run.folder.string()},         {"title", taken.run.scene.title},
      {"revision", theirs.value("revision", "")}, {"snapshot", taken.snapshot.filename().string()},
      {"sum", file_sum(taken.snapshot).checksum}, {"time_s", taken.time_s}};
  if (theirs.contains("started_from")) chain["started_from"] = theirs["started_from"];
  scene.grains.source = std::move(taken.grains);
  return chain;
}

}  // namespace drumlin::apps
