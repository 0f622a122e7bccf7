// The worst pair of shipped scenes: discs are rigid in every step, not only in the mean.
#include <fmt/format.h>

#include <filesystem>

#include "particles/scene/scene_file.hpp"
#include "particles/stepping/run_through.hpp"
#include "tests/hardcases/registry.hpp"

namespace drumlin {
using namespace particles;
namespace {

struct ShippedScene {
  const char* name;
  std::vector<std::string> changes;
  double largest;  ///< overlap of any step of the last stage, d
};

std::vector<HardCheck> worst_pair(const std::filesystem::path& file, const ShippedScene& shipped) {
  Simulation simulation(read_scene(file, shipped.changes));
  const auto stages = static_cast<int>(simulation.scene().stages.size());
  double largest = 0, steps = 0, missed = 0;
  while (!simulation.finished()) {
    const bool counts = simulation.next_stage() == stages - 1;
    const StepReport report = simulation.step();
    if (!counts) continue;
    largest = larger(largest, report.overlap.max);
    missed += !is_converged(report), ++steps;
  }
  return {at_most("largest overlap of any step of the last stage", shipped.largest, largest,
                  "what its solver leaves, and nothing of impacts, flights and searches"),
          at_most("share of steps that missed a tolerance", 0.01, missed / steps, "a warning begins there")};
}

}  // namespace

std::vector<HardCase> scene_cases(const std::filesystem::path& scenes) {
  const std::string third = "solver.tolerance=3e-3";
  const std::vector<ShippedScene> all = {
      {"drum-6rpm", {third, "stages.1.turns=0.1", "stages.2.turns=0.1", "stages.2.snapshots=10"}, 1e-3},
      {"chute", {third}, 1e-3},
      {"silo", {third}, 1e-3},
      {"segregation-drum", {third}, 1e-3},
      {"vibrated-layer", {third}, 1e-3},
      {"hourglass", {}, 1e-2},
      {"column-collapse", {}, 1e-2}};
  std::vector<HardCase> cases;
  for (const ShippedScene& scene : all)
    cases.push_back(
        {fmt::format("worst-{}", scene.name),
         fmt::format("{}: no two discs overlap by more than {:g} d", scene.name, scene.largest), false,
         [file = scenes / fmt::format("{}.toml", scene.name), scene] { return worst_pair(file, scene); }});
  return cases;
}

}  // namespace drumlin
